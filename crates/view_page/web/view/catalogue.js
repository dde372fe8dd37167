// What the server says about the dataset, with the types of its answers.

import { getBytes, getJson } from "../shared/api.js";

/** @typedef {{ name: string, title: string, pass: string, like: string, channels: number, dtype: string, unit: string, space: string, sentinel: string, description: string }} LayerSpec a layer or a derived picture; `like` is what has the colours and names of its numbers */
/** @typedef {{ id: number, name: string, color: number[] }} SemanticClass */
/** @typedef {{ title: string, path: string }} Page */
/** @typedef {{ passed: boolean, accepted: boolean, verdict: string, gate_verdict: string, laws: number, frames: number, rejected: number, failures: { law: string, statement: string, place: string, meaning: string }[] }} Verification */
/** @typedef {{ name: string, scenes: string[], scenes_with_other_names: string[], layers: LayerSpec[], pages: Page[], verify: Verification | null, verify_problem: string | null }} Dataset `verify_problem` says why verify.json is no report */
/** @typedef {{ center: number[], extents: number[], orientation: number[] }} Box */
/** @typedef {{ names: string[], semantic: number[], instance: number[] }} Objects what the pieces of the geometry are: parts, and pieces of those that people split */
/** @typedef {{ name: string, cameras: string[], meters_per_unit: number, classes: SemanticClass[], parts: string[], objects: Objects, materials: string[], instance_colors: number[][], boxes: Record<string, (Box | null)[]>, described: Described, has_pairs: boolean, has_geometry: boolean, has_space: boolean, pages: Page[], problems: Loss[] }} Scene */
/** @typedef {{ instance: number, name: string, noun: string, room: string, color: string, material: string, size_m: number[] }} DescribedInstance */
/** @typedef {{ subject: number, kind: string, object: number, object_semantic: number, distance_m: number }} Relation */
/** @typedef {{ instances: DescribedInstance[], relations: Relation[], rooms: { name: string, kind: string }[], planes: string[] }} Described */
/** @typedef {{ position: number[], orientation: number[] }} Pose */
/** @typedef {{ by: "planning" | "verification", gate: string, measure: string, value: number | null, limit: number, side: string, unit: string, rejects: boolean }} Fault a gate that a frame does not pass */
/** @typedef {{ panel: string, error: string, help: string }} Loss a file that cannot be read, and the panel that lacks it */
/** @typedef {{ frame: number, pose: Pose | null, layers: number[], derived: number[], complete: boolean, faults: Fault[], picture: string | null }} CameraFrame */
/** @typedef {{ kind: string, linear: boolean, width: number, height: number, corner_rays: number[][] | null, fov_y_deg: number | null }} Projection */
/** @typedef {{ name: string, frame_time_s: number, projection: Projection | null, loader_problem: string | null, frames: CameraFrame[], derived: LayerSpec[], has_tracks: boolean, tone: [number, number, number][], problems: Loss[] }} Camera */
/** @typedef {{ instance: number, semantic: number, visible_pixels: number, visible_box: number[], full_box: number[], visibility: number, truncation: number }} InstanceView */
/** @typedef {{ kind: string, question: string, options: string[] | null, answer: string, instances: number[], of_all_frames: boolean }} Question */
/** @typedef {{ camera: string, frame: number, this_seen: number | null, that_seen: number | null, baseline_m: number | null, angle_deg: number | null, listed: boolean | null }} Partner a frame that shows surfaces of another: shares of this frame that it sees, and of it that this frame sees */
/** @typedef {{ partners: Partner[], count: number, hidden_by: string, problems: Loss[] }} Pairs */
/** @typedef {{ record: any, labels: any, instances: InstanceView[], split: { partition?: string, excluded?: string } | null, judged: any, words: { caption: string | null, questions: Question[] }, sensor_tables: { sensor: string, path: string }[], problems: Loss[] }} FrameFacts */
/** @typedef {{ camera: string, frame: number, version: string | null, picture: string | null, noise: number | null, clipped: number | null, black: number | null, exposure: number | null, depth_range: number | null, coverage: number | null, objects: number | null, partition: string | null, faults: Fault[], laws: string[] }} GalleryFrame */

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

/** What the server says of a camera now, as text. @param {string} scene @param {string} camera */
export const peek = async (scene, camera) => JSON.stringify(await getJson(`../api/view/camera/${encodeURIComponent(scene)}/${encodeURIComponent(camera)}`));

/** What the server says of the dataset now, as text. */
export const peekDataset = async () => JSON.stringify(await getJson("../api/view/dataset"));

/** @param {string} scene @param {string} camera @param {number} frame @returns {Promise<FrameFacts>} */
export const getFrame = (scene, camera, frame) =>
    once(`../api/view/frame/${encodeURIComponent(scene)}/${encodeURIComponent(camera)}/${frame}`);

/** @param {string} scene @param {string} camera @param {number} frame @returns {Promise<Pairs>} */
export const getPairs = (scene, camera, frame) => once(`../api/view/pairs/${encodeURIComponent(scene)}/${encodeURIComponent(camera)}/${frame}`);

/** The points that are followed through a camera's frames, as a buffer. @param {string} scene @param {string} camera @returns {Promise<ArrayBuffer>} */
export const getTracks = (scene, camera) => getBytes(`../api/view/tracks/${encodeURIComponent(scene)}/${encodeURIComponent(camera)}`);

/** @param {string} scene @returns {Promise<{ frames: GalleryFrame[], problems: Loss[] }>} */
export const getGallery = (scene) => getJson(`../api/view/gallery/${encodeURIComponent(scene)}`);

/** @param {string} scene @returns {Promise<{ classes: SemanticClass[], frames: { camera: string, frame: number, shares: Record<string, number> }[], problems: Loss[] }>} */
export const getClassShares = (scene) => getJson(`../api/view/class_shares/${encodeURIComponent(scene)}`);

/** The address of a picture or page of the dataset. @param {string} path */
export const fileUrl = (path) => `../api/view/file/${path.split("/").map(encodeURIComponent).join("/")}`;

/** The address of a frame's small picture; with the version that the gallery tells, browsers keep it. @param {string} scene @param {string} camera @param {number} frame @param {string} [version] */
export const thumbnailUrl = (scene, camera, frame, version) =>
    `../api/view/thumbnail/${encodeURIComponent(scene)}/${encodeURIComponent(camera)}/${frame}${version ? `?v=${version}` : ""}`;
