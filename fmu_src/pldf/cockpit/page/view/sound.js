// Motor, wind and road, made by the browser as one drives: without them speed is misjudged.
import { Motor } from "./motor.js";

const NOISE_S = 4;
const FOLLOW_S = 0.07; // how fast the sound follows the car
const LOUDNESS = 0.85;
// Strengths of the motor's harmonics: uneven ones are weak in a motor of four cylinders.
const HARMONICS = [0, 1, 0.55, 0.62, 0.35, 0.3, 0.16, 0.18, 0.08, 0.07];

/** To be made in the wake of a key or a click: browsers let no page sound before. */
export class Sound {
  constructor() {
    this.motor = new Motor();
    /** null: a browser without sound; a drive without is better than none @type {Parts | null} */
    this.parts = globalThis.AudioContext ? parts(new AudioContext()) : null;
    // Refused before the first key or click, and when it is over before it began.
    this.parts?.context.resume().catch(() => {});
  }

  /**
   * What is heard from now on.
   * @param {import("./motor.js").Motion & {running: boolean}} motion not running: silence
   */
  play({ running, ...motion }) {
    const noise = this.motor.noise(motion);
    const { parts: made } = this;
    if (!made) return;
    const follow = (/** @type {AudioParam} */ param, /** @type {number} */ value) =>
      param.setTargetAtTime(value, made.context.currentTime, FOLLOW_S);
    follow(made.motor.frequency, noise.motor_hz);
    follow(made.under.frequency, noise.motor_hz / 2);
    follow(made.motorTone.frequency, noise.motor_tone_hz);
    follow(made.motorGain.gain, noise.motor);
    follow(made.roadTone.frequency, noise.road_tone_hz);
    follow(made.roadGain.gain, noise.road);
    follow(made.windTone.frequency, noise.wind_tone_hz);
    follow(made.windGain.gain, noise.wind);
    follow(made.all.gain, running ? LOUDNESS : 0);
  }

  /** Nothing can be heard afterwards. */
  dispose() {
    this.parts?.context.close().catch(() => {});
    this.parts = null;
  }
}

/** @typedef {ReturnType<typeof parts>} Parts */

/** @param {AudioContext} context */
function parts(context) {
  const all = volume(context, 0, context.destination);
  const motorGain = volume(context, 0, all);
  const motorTone = filter(context, "lowpass", motorGain);
  const motor = tone(context, motorTone);
  const under = tone(context, motorTone);
  const roadGain = volume(context, 0, all);
  const roadTone = filter(context, "lowpass", roadGain);
  const windGain = volume(context, 0, all);
  const windTone = filter(context, "bandpass", windGain);
  const noise = context.createBufferSource();
  noise.buffer = rushing(context);
  noise.loop = true;
  noise.connect(roadTone);
  noise.connect(windTone);
  noise.start();
  return {
    context,
    all,
    motor,
    under,
    motorTone,
    motorGain,
    roadTone,
    roadGain,
    windTone,
    windGain,
  };
}

/** @param {AudioContext} context @param {number} gain @param {AudioNode} to */
function volume(context, gain, to) {
  const made = context.createGain();
  made.gain.value = gain;
  made.connect(to);
  return made;
}

/** @param {AudioContext} context @param {BiquadFilterType} type @param {AudioNode} to */
function filter(context, type, to) {
  const made = context.createBiquadFilter();
  made.type = type;
  made.Q.value = 0.6;
  made.connect(to);
  return made;
}

/** @param {AudioContext} context @param {AudioNode} to */
function tone(context, to) {
  const made = context.createOscillator();
  const strengths = new Float32Array(HARMONICS);
  made.setPeriodicWave(context.createPeriodicWave(new Float32Array(strengths.length), strengths));
  made.connect(to);
  made.start();
  return made;
}

/** Noise of all pitches. @param {AudioContext} context */
function rushing(context) {
  const buffer = context.createBuffer(1, NOISE_S * context.sampleRate, context.sampleRate);
  const samples = buffer.getChannelData(0);
  for (let k = 0; k < samples.length; k++) samples[k] = 2 * Math.random() - 1;
  return buffer;
}
