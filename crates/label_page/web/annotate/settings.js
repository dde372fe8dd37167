// The dialog "Camera and scene": flying speed, near plane, faces while moving, and numbers of the scene.

import { el, spaced } from "../shared/dom.js";

/** Faces that are drawn while the camera moves: the value, and its name. */
const PACES = [["", "as many as run smoothly"], ["50000", "50 000"], ["200000", "200 000"], ["1000000", "1 000 000"], ["Infinity", "all"]];

/**
 * The dialog, and what opens it.
 *
 * @param {import("./state.js").State} state
 * @param {import("../shared/stage3d/stage.js").Stage3d} stage
 * @returns {() => void}
 */
export function settingsDialog(state, stage) {
    /** @param {string} text @param {string} unit @param {Record<string, string>} limits @param {() => number} get @param {(value: number) => void} set */
    const number = (text, unit, limits, get, set) => {
        const input = el("input", { type: "number", ...limits });
        input.addEventListener("change", () => {
            if (input.checkValidity() && input.value !== "") set(Number(input.value));
            input.value = String(Number(get().toFixed(3)));
        });
        return { row: el("label", { class: "setting" }, el("span", {}, text), input, el("span", { class: "quiet" }, unit)), show: () => (input.value = String(Number(get().toFixed(3)))) };
    };
    const { controls } = stage;
    const speed = number("Flying speed", "m/s", { min: "0.01", max: "1000", step: "any" }, () => controls.speed, (value) => {
        controls.speed = value;
        state.set({});
        stage.cameraMoved();
    });
    const near = number("Nothing nearer than", "m", { min: "0", max: "1000", step: "any" }, () => stage.near, (value) => stage.setNear(value));
    const pace = el("select", {}, ...PACES.map(([value, text]) => el("option", { value }, text)));
    pace.addEventListener("change", () => (stage.pace.fixed = pace.value === "" ? null : Number(pace.value)));
    const { bounds, faces, vertices } = state.scene;
    const size = bounds.max.map((/** @type {number} */ v, /** @type {number} */ axis) => (v - bounds.min[axis]).toFixed(2)).join(" × ");
    const pieces = el("dd", { class: "number" });
    const facts = el("dl", { class: "facts" },
        el("dt", {}, "Faces"), el("dd", { class: "number" }, spaced(faces)), el("dt", {}, "Vertices"), el("dd", { class: "number" }, spaced(vertices)),
        el("dt", {}, "Pieces"), pieces, el("dt", {}, "Size"), el("dd", { class: "number" }, `${size} m`), el("dt", {}, "Drawn by"), el("dd", {}, stage.graphics));
    const dialog = el("dialog", { class: "settings", "aria-label": "Camera and scene" }, el("h2", {}, "Camera and scene"), speed.row, near.row,
        el("p", { class: "quiet" }, "Anything nearer is neither drawn nor changed, so you can look into closed rooms."),
        el("label", { class: "setting" }, el("span", {}, "Faces while moving"), pace), el("p", { class: "quiet" }, "At rest all faces are drawn."), facts, el("form", { method: "dialog" }, el("button", { autofocus: true }, "Close")));
    document.body.append(dialog);
    return () => {
        speed.show();
        near.show();
        pieces.textContent = spaced(state.count);
        dialog.showModal();
    };
}
