// How each layer is shown: by its channels, unit and type, so that layers this page does not know are shown too.

/** @typedef {import("./catalogue.js").LayerSpec} LayerSpec */
/** @typedef {"radiance" | "albedo" | "scalar" | "direction" | "stretched" | "flow" | "texture" | "id" | "code" | "display"} Kind */
/** @typedef {{ kind: Kind, map: string, range: "percentiles" | "extremes" | "unit" | "symmetric", of?: "part" | "instance" | "class" | "material" | "plane" }} Look */

/** @type {Record<string, Partial<Look>>} */
const SPECIAL = {
    tex_coord: { kind: "texture" },
    semantic: { of: "class" },
    semantic_instance: { of: "instance" },
    material_id: { of: "material" },
    plane: { of: "plane" },
    color_standard_error: { map: "inferno" },
    metallic: { range: "unit", map: "grey" },
    roughness: { range: "unit" },
    transmission_weight: { range: "unit", map: "grey" },
    display: { kind: "display" },
    raw: { map: "grey" },
    intensity: { range: "unit", map: "grey" },
    scene_flow: { range: "symmetric" },
};

/**
 * @param {LayerSpec} spec
 * @returns {Look}
 */
export function lookOf(spec) {
    return { kind: kindOf(spec), map: "viridis", range: "percentiles", of: "part", ...SPECIAL[spec.like] };
}

/** @param {LayerSpec} spec @returns {Kind} */
function kindOf(spec) {
    if (spec.dtype === "i16") return "id";
    if (spec.dtype === "u8") return "code";
    if (spec.channels === 1) return "scalar";
    if (spec.channels === 2) return "flow";
    if (spec.space.startsWith("linear RGB")) return spec.unit ? "radiance" : "albedo";
    return spec.unit ? "stretched" : "direction";
}

/**
 * The values that a scalar layer's map spans: the user's, else those of the look.
 * @param {Look} look
 * @param {import("./numbers.js").Summary} summary
 * @param {[number, number] | undefined} chosen
 * @param {boolean} [logarithm] both ends must be positive
 * @returns {[number, number]}
 */
export function rangeOf(look, summary, chosen, logarithm = false) {
    const [low, high] = chosen ?? ownRange(look, summary);
    if (!logarithm || low > 0) return [low, high];
    // Zero has no logarithm: the map begins at the first positive percentile.
    const top = high > 0 ? high : 1;
    return [summary.percentiles.find((value) => value > 0 && value < top) ?? top / 1000, top];
}

/** @param {Look} look @param {import("./numbers.js").Summary} summary @returns {[number, number]} */
function ownRange(look, summary) {
    if (look.range === "unit") return [0, 1];
    const [low, high] = summary.range ?? [0, 1];
    const p = summary.percentiles;
    if (look.kind === "flow") return [0, p[6] || high || 1];
    if (look.range === "symmetric") return [-(p[6] || 1), p[6] || 1];
    if (look.range === "extremes" || p.length < 7 || p[6] <= p[0]) return low < high ? [low, high] : [low, low + 1];
    return [p[0], p[6]];
}

/** Groups of layers for the lists, in order. */
export const GROUPS = [
    { name: "Light", passes: ["final", "rendered"] },
    { name: "Guides of denoising", passes: ["guides"] },
    { name: "Light in parts", passes: ["split"] },
    { name: "Geometry", passes: ["geometry"] },
    { name: "Labels", passes: ["label"] },
    { name: "Material, motion, boundaries", passes: ["extra"] },
    { name: "Light by fixture", passes: ["fixtures"] },
    { name: "Mixes of fixtures", passes: ["mixes"] },
    { name: "Surfaces along rays", passes: ["surfaces"] },
    { name: "Rooms", passes: ["rooms"] },
    { name: "To other frames", passes: ["pairs"] },
    { name: "Sensors", passes: ["sensors"] },
];
