// What an FMU says when it refuses a call.

/** @typedef {{level: "info" | "warning" | "error", text: string}} Message */

/** A call that an FMU refused; the text is what the FMU said. */
export class FmuError extends Error {
  /**
   * @param {string} call
   * @param {string} model
   * @param {Message[]} messages since the call began
   */
  constructor(call, model, messages) {
    const told = messages.filter((m) => m.level === "error").map((m) => m.text);
    super(`${model}: ${told.join("; ") || `${call} failed`}`);
    this.name = "FmuError";
    this.call = call;
    this.model = model;
  }
}
