"""Learning only what is consistent: evidence and pending demonstrations (section 6)."""

from __future__ import annotations

from .arrays import NextArrays, ProfileArrays


def keep_evidence(profile: ProfileArrays, following: NextArrays) -> None:
    """Start from the evidence and the pending demonstrations that were known before the drive."""
    for i in range(len(profile.evidence_faster)):
        following.evidence_faster[i] = profile.evidence_faster[i]
        following.evidence_slower[i] = profile.evidence_slower[i]
        following.pending_faster[i] = profile.pending_faster[i]
        following.pending_slower[i] = profile.pending_slower[i]
        following.pending_faster_mps[i] = profile.pending_faster_mps[i]
        following.pending_slower_mps[i] = profile.pending_slower_mps[i]
        following.offset_evidence_faster[i] = profile.offset_evidence_faster[i]
        following.offset_evidence_slower[i] = profile.offset_evidence_slower[i]
        following.offset_pending_faster[i] = profile.offset_pending_faster[i]
        following.offset_pending_slower[i] = profile.offset_pending_slower[i]
        following.offset_pending_faster_mps[i] = profile.offset_pending_faster_mps[i]
        following.offset_pending_slower_mps[i] = profile.offset_pending_slower_mps[i]
