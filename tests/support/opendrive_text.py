"""Small OpenDRIVE files as text."""

from __future__ import annotations

RIGHT_100 = '<type s="0" type="rural"><speed max="100" unit="km/h"/></type>'


SHAPES = {
    "line": "<line/>",
    "arc": '<arc curvature="-0.012"/>',
    "spiral": '<spiral curvStart="0.004" curvEnd="-0.015"/>',
    "poly3": '<poly3 a="0" b="0" c="0.003" d="-0.00004"/>',
    "arcLength": '<paramPoly3 aU="0" bU="1" cU="0" dU="-0.000002" aV="0" bV="0" cV="0.0015" '
    'dV="-0.000005" pRange="arcLength"/>',
    "normalized": '<paramPoly3 aU="0" bU="79" cU="0" dU="-0.5" aV="0" bV="0" cV="9" dV="-4" '
    'pRange="normalized"/>',
}


def geometry(s: float, length: float, shape: str = "<line/>", pose: str = "") -> str:
    pose = pose or f'x="{s}" y="0" hdg="0"'
    return f'<geometry s="{s}" {pose} length="{length}">{shape}</geometry>'


def road(
    road_id: str,
    plan: str,
    *,
    length: float = 100.0,
    link: str = "",
    inside: str = RIGHT_100,
    attributes: str = 'junction="-1"',
) -> str:
    return (
        f'<road id="{road_id}" length="{length}" {attributes}>\n<link>{link}</link>\n'
        f"{inside}\n<planView>\n{plan}\n</planView>\n</road>"
    )


def link(end: str, element: str, contact: str = "", kind: str = "road") -> str:
    point = f'contactPoint="{contact}"' if contact else ""
    return f'<{end} elementType="{kind}" elementId="{element}" {point}/>'


def straight(road_id: str, x: float = 0.0, **more: object) -> str:
    """Return a road of 100 m to the east that begins at ``x``."""
    plan = geometry(0, 100, pose=f'x="{x}" y="0" hdg="0"')
    return road(road_id, plan, **more)  # type: ignore[arg-type]


def lanes(*sections: str) -> str:
    return f"{RIGHT_100}<lanes>{''.join(sections)}</lanes>"


def lane(speeds: str, kind: str = "driving", side: str = "right", lane_id: int = -1) -> str:
    return f'<{side}><lane id="{lane_id}" type="{kind}">{speeds}</lane></{side}>'
