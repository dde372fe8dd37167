// What the server says about the dataset, with the types of its answers.

import { getJson } from "../shared/api.js";

/** @typedef {{ name: string, pass: string, channels: number, dtype: string, unit: string, space: string, sentinel: string, description: string }} LayerSpec */
/** @typedef {{ id: number, name: string, color: number[] }} SemanticClass */
/** @typedef {{ title: string, path: string }} Page */
/** @typedef {{ passed: boolean, accepted: boolean, verdict: string, gate_verdict: string, laws: number, frames: number, failures: { law: string, statement: string, place: string, meaning: string }[] }} Verification */
/** @typedef {{ name: string, scenes: string[], scenes_with_other_names: string[], layers: LayerSpec[], pages: Page[], verify: Verification | null }} Dataset */
/** @typedef {{ center: number[], extents: number[], orientation: number[] }} Box */
/** @typedef {{ names: string[], semantic: number[], instance: number[] }} Objects what the pieces of the geometry are: parts, and pieces of those that people split */
/** @typedef {{ name: string, cameras: string[], meters_per_unit: number, classes: SemanticClass[], parts: string[], objects: Objects, materials: string[], instance_colors: number[][], boxes: Record<string, (Box | null)[]>, has_geometry: boolean, has_space: boolean, pages: Page[] }} Scene */
/** @typedef {{ position: number[], orientation: number[] }} Pose */
/** @typedef {{ verdict: "rejected" | "reported", fault: { gate: string, value: number, limit: number } | null, picture: string | null }} Gate */
/** @typedef {{ frame: number, pose: Pose | null, layers: number[], complete: boolean, gate: Gate | null }} CameraFrame */
/** @typedef {{ kind: string, linear: boolean, width: number, height: number, corner_rays: number[][] | null, fov_y_deg: number | null }} Projection */
/** @typedef {{ name: string, frame_time_s: number, projection: Projection | null, loader_problem: string | null, frames: CameraFrame[], tone: [number, number, number][] }} Camera */
/** @typedef {{ instance: number, semantic: number, visible_pixels: number, visible_box: number[], full_box: number[], visibility: number, truncation: number }} InstanceView */
/** @typedef {{ record: any, labels: any, instances: InstanceView[], split: { partition?: string, excluded?: string } | null, judged: any }} FrameFacts */

/** Answers that do not change while one looks; a failure is asked for again. @type {Map<string, Promise<any>>} */
const answers = new Map();

/**
 * @param {string} path
 * @returns {Promise<any>}
 */
function once(path) {
    const known = answers.get(path);
    if (known) return known;
    const answer = getJson(path);
    answers.set(path, answer);
    answer.catch(() => answers.delete(path));
    return answer;
}

/** Forgets what was answered, so that a dataset in the making is seen as it is now. */
export const forget = () => answers.clear();

/** @returns {Promise<Dataset>} */
export const getDataset = () => once("../api/view/dataset");

/** @param {string} scene @returns {Promise<Scene>} */
export const getScene = (scene) => once(`../api/view/scene/${encodeURIComponent(scene)}`);

/** @param {string} scene @param {string} camera @returns {Promise<Camera>} */
export const getCamera = (scene, camera) => once(`../api/view/camera/${encodeURIComponent(scene)}/${encodeURIComponent(camera)}`);

/** @param {string} scene @param {string} camera @param {number} frame @returns {Promise<FrameFacts>} */
export const getFrame = (scene, camera, frame) =>
    once(`../api/view/frame/${encodeURIComponent(scene)}/${encodeURIComponent(camera)}/${frame}`);

/** The address of a picture or page of the dataset. @param {string} path */
export const fileUrl = (path) => `../api/view/file/${path.split("/").map(encodeURIComponent).join("/")}`;
