// What a drive tells other windows while it goes on: the cluster on a tablet, the experimenter.

/** @typedef {import("../types.js").Value} Value */
/** @typedef {import("../language.js").Language} Language */
/** @typedef {"none" | "icon" | "text"} Explanation how much the cluster explains */
/** @typedef {"KMH" | "MPH"} Unit of speeds, as `hmi.unit` */

/**
 * A moment, every 50 ms while the car drives. A simulator needs to send nothing else, and may leave
 * out `kind` and `participant`.
 * @typedef {object} FrameMessage
 * @property {"frame"} [kind]
 * @property {string} [participant]
 * @property {string} [phase]
 * @property {number} time_s since the drive began
 * @property {Record<string, Value>} values by names of the FMUs; enumerations as codes
 */
/**
 * Where the person is, whenever that changes.
 * @typedef {object} StatusMessage
 * @property {"status"} kind
 * @property {string} participant
 * @property {string} phase of the drive that goes on or was the last one, or empty
 * @property {string} place in the session, in words
 * @property {number} position of that place, from 1
 * @property {number} of how many there are
 * @property {"driving" | "paused" | "between" | "ended"} state
 * @property {string} reason of a pause or an end, or empty
 * @property {"AB" | "BA"} order of the two systems
 * @property {Explanation} explanation
 * @property {Unit} unit
 * @property {Language} language
 * @property {number} learned_places how many there are now
 * @property {number} end_m where the drive ends
 */
/** @typedef {{kind: "abort", participant: string, reason: string}} AbortMessage from the experimenter */
/** @typedef {FrameMessage | StatusMessage | AbortMessage} LiveMessage */

export const FRAME_MS = 50;
const AGAIN_MS = 1000;

/**
 * Tell what a message is, whoever sent it: nothing in it is trusted.
 * @param {string} text
 * @returns {LiveMessage | null} null if it is none
 */
export function messageOf(text) {
  const parsed = parse(text);
  if (typeof parsed !== "object" || parsed === null) return null;
  const message = /** @type {Record<string, unknown>} */ (parsed);
  const kind = message["kind"] ?? "frame";
  if (kind === "frame") return frameOf(message);
  const named = typeof message["participant"] === "string";
  if ((kind !== "status" && kind !== "abort") || !named) return null;
  return /** @type {LiveMessage} */ (parsed);
}

/** @param {string} text @returns {unknown} */
function parse(text) {
  try {
    return JSON.parse(text);
  } catch {
    return null;
  }
}

/** @param {Record<string, unknown>} message @returns {FrameMessage | null} */
function frameOf(message) {
  const { values, time_s: time, participant = "", phase = "" } = message;
  if (typeof values !== "object" || values === null) return null;
  const frame = { kind: "frame", participant: String(participant), phase: String(phase), values };
  return /** @type {FrameMessage} */ ({ ...frame, time_s: typeof time === "number" ? time : 0 });
}

/** The line to the server beside the page; it is made anew when it breaks. */
export class Live {
  /**
   * @param {(message: LiveMessage) => void} onmessage what others say
   * @param {(connected: boolean) => void} [onstate]
   */
  constructor(onmessage, onstate = () => {}) {
    this.onmessage = onmessage;
    this.onstate = onstate;
    /** @type {WebSocket | null} */
    this.socket = null;
    this.closed = false;
    /** @type {Map<string, StatusMessage>} */
    this.statuses = new Map();
    this.connect();
  }

  connect() {
    const address = new URL("api/live", location.href);
    address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
    const socket = new WebSocket(address);
    this.socket = socket;
    socket.addEventListener("open", () => {
      this.onstate(true);
      for (const status of this.statuses.values()) this.send(status);
    });
    socket.addEventListener("message", ({ data }) => {
      const message = messageOf(String(data));
      if (message !== null) this.onmessage(message);
    });
    socket.addEventListener("close", () => {
      this.onstate(false);
      if (!this.closed) setTimeout(() => this.connect(), AGAIN_MS);
    });
  }

  /**
   * Tell the others. What cannot be told now is not told later, but for the newest status.
   * @param {LiveMessage} message
   */
  send(message) {
    if (message.kind === "status") this.statuses.set(message.participant, message);
    const { socket } = this;
    if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
  }

  close() {
    this.closed = true;
    this.socket?.close();
  }
}
