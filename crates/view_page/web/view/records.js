// The panels "Frame" and "Views": everything recorded about the frame, and which views of the trajectory were rendered or rejected.

import { el, facts } from "../shared/dom.js";
import { fileUrl, thumbnailUrl } from "./catalogue.js";
import { captionPart, questionsPart, roomsPart } from "./described.js";
import { brief, percent } from "./numbers.js";

/** @typedef {import("./session.js").Session} Session */

/** @param {Session} session @param {import("./catalogue.js").FrameFacts | null} known */
export function framePanel(session, known) {
    const { camera } = session;
    const { frame } = session.store.state;
    const entry = camera?.frames.find((one) => one.frame === frame);
    if (!known || !camera) return [el("p", { class: "quiet" }, "Reading …")];
    const { record, labels, judged, split } = known;
    const projection = camera.projection;
    const vector = (/** @type {number[] | undefined} */ v) => v && v.map((x) => x.toFixed(3)).join(", ");
    const pose = entry?.pose;
    return [
        el("h2", {}, `Frame ${frame}`),
        facts([
            ["State", entry?.complete ? "complete" : "not complete"],
            ["Split", split?.partition ?? (split?.excluded && `excluded: ${split.excluded}`)],
            ["Gates", entry?.faults.length ? entry.faults.map(faultText).join("; ") : "all passed"],
        ]),
        ...captionPart(known),
        ...roomsPart(session),
        ...(known.sensor_tables.length ? [el("h2", {}, "Readings"), ...known.sensor_tables.map(({ sensor, path }) => el("p", {}, el("a", { href: fileUrl(path), target: "_blank" }, `${sensor}: ${path.split("/").at(-1)}`)))] : []),
        el("h2", {}, "Camera"),
        facts([
            ["Model", projection?.kind],
            ["Size", projection && `${projection.width} × ${projection.height} px`],
            ["Field of view", projection?.fov_y_deg && `${projection.fov_y_deg.toFixed(2)}° vertical`],
            ["Hypersim's loaders", camera.loader_problem],
            ["Position", pose && `${vector(pose.position)} m`],
            ["Looks along", pose && vector([2, 5, 8].map((i) => -pose.orientation[i]))],
        ]),
        ...(record ? [el("h2", {}, "Record"), facts([
            ["Samples", record.samples && `${record.samples} per pixel`],
            ["Taken", record.samples_taken && brief(record.samples_taken)],
            ["Noise", typeof record.noise === "number" ? percent(record.noise) : null],
            ["Ended by", record.stopped_by],
            ["Seed", record.seed],
            ["Program", record.recipe?.program],
            ["Labels", labels && `joined from ${String(labels.labels_hash).slice(0, 12)}`],
            ["Color", record.color === "denoised" ? `denoised by ${record.denoised?.denoiser}` : "as rendered"],
            ["Files", `${Object.keys(record.files).length}, ${(/** @type {any[]} */ (Object.values(record.files)).reduce((sum, file) => sum + file.bytes, 0) / 1e6).toFixed(1)} MB`],
            ["Hash", String(record.config_hash).slice(0, 16)],
        ])] : []),
        ...(judged ? [el("h2", {}, "Verification"), facts([
            ["Noise", typeof judged.noise === "number" ? percent(judged.noise) : null],
            ["Clipped", typeof judged.clipped_share === "number" ? percent(judged.clipped_share) : null],
            ["Black", typeof judged.black_share === "number" ? percent(judged.black_share) : null],
            ["Labelled", typeof judged.labelled_share === "number" ? percent(judged.labelled_share) : null],
            ...Object.entries(judged.pixels ?? {}).map(([name, share]) => /** @type {[string, string]} */ ([name.replaceAll("_", " "), percent(/** @type {number} */ (share))])),
            ...Object.entries(judged.gates ?? {}).map(([name, value]) => /** @type {[string, string]} */ ([name.replaceAll("_", " "), brief(/** @type {number} */ (value))])),
        ])] : []),
        ...questionsPart(known),
    ];
}

/** A gate that was not passed, in words. @param {import("./catalogue.js").Fault} fault */
export function faultText({ by, gate, value, limit, side, unit, rejects }) {
    const [measured, bound] = unit === "share" ? [value, limit].map((v) => (v === null ? "no number" : percent(v))) : [value === null ? "no number" : brief(value), brief(limit)];
    return `${rejects ? "rejected" : "reported"} by ${by}: ${gate} ${measured}${unit && unit !== "share" ? ` ${unit}` : ""}, limit ${side}${side ? " " : ""}${bound}`;
}

/** @param {Session} session */
export function viewsPanel(session) {
    const { camera, scene } = session;
    if (!camera || !scene) return [];
    const judged = camera.frames.filter((frame) => frame.faults.length);
    const rejected = judged.filter((frame) => frame.faults.some((fault) => fault.rejects));
    const planned = camera.frames.filter((frame) => !frame.layers.length && !frame.faults.length);
    const page = scene.pages.find((one) => one.title === "Rejected views");
    const card = (/** @type {import("./catalogue.js").CameraFrame} */ { frame, faults, picture, layers }) => {
        const address = picture ? fileUrl(picture) : layers.length ? thumbnailUrl(scene.name, camera.name, frame) : "";
        return el("button", { type: "button", class: "view", disabled: !layers.length, "data-rejected": frame, onclick: () => session.store.set({ frame }) },
            el("img", { src: address || undefined, alt: "", loading: "lazy" }),
            el("span", {}, el("b", {}, `Frame ${frame}`), ...faults.flatMap((fault) => [el("br"), faultText(fault)])));
    };
    return [
        facts([
            ["Views", camera.frames.length],
            ["With pictures", session.frames().length],
            ["Rejected", rejected.length],
            ["Reported", judged.length - rejected.length],
            ["Not rendered", planned.length],
        ]),
        el("h2", {}, "Rejected and reported"),
        judged.length ? el("div", { class: "views" }, ...judged.map(card)) : el("p", { class: "quiet" }, "No gate found fault with a view of this trajectory."),
        page ? el("p", {}, el("a", { href: fileUrl(page.path), target: "_blank" }, "The page of all rejected views")) : null,
    ].filter((child) => child !== null);
}

/** Files that could not be read and that a panel lacks. @param {Session} session @param {import("./catalogue.js").FrameFacts | null} known @param {string} panel */
export function lossesOf(session, known, panel) {
    const all = [...(session.scene?.problems ?? []), ...(session.camera?.problems ?? []), ...(known?.problems ?? [])];
    return all.filter((loss) => loss.panel === panel).map(lossNote);
}

/** @param {import("./catalogue.js").Loss} loss */
export const lossNote = ({ error, help }) => el("div", { class: "loss", role: "note" }, el("b", {}, "A file cannot be read"), el("code", {}, error), help);
