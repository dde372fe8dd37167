// The exposure: the factor of radiance before the tone curve.

/** @typedef {import("./catalogue.js").Camera} Camera */

/** @type {["hypersim", "filmic", "linear"]} */
export const TONES = ["hypersim", "filmic", "linear"];

/**
 * Hypersim's rule shows the 90th percentile of brightness at 0.8. The scale is in the dataset's table; without a table the server computes
 * it from color.
 * @param {import("./state.js").State} state
 * @param {Camera} camera
 * @param {number} frame
 * @param {import("./numbers.js").Summary} summary of the layer that is shown
 */
export function exposureOf(state, camera, frame, summary) {
    const stops = 2 ** state.stops;
    if (state.expose === "fixed") return stops;
    const row = camera.tone.find(([number]) => number === frame);
    if (state.expose === "trajectory" && camera.tone.length) return stops * (row ?? camera.tone[0])[2];
    // Without a table and without `render_entity_id`, the 95th percentile is close enough.
    const bright = summary.percentiles[5];
    return stops * (row?.[1] ?? summary.tone_scale ?? (bright > 0 ? 0.8 ** 2.2 / bright : 1));
}
