// The panel of the 3D view: what is shown, in which colours, and from where. It folds, so that it hides nothing.

import { el } from "../shared/dom.js";

/** @typedef {"surfaces" | "points" | "free" | "occupied" | "views" | "boxes"} SpacePart */

/** @type {[SpacePart, string][]} */
const PARTS = [["surfaces", "Surfaces"], ["points", "Points of the frame"], ["views", "Trajectory and views"], ["boxes", "Boxes"], ["free", "Free space"], ["occupied", "Occupied space"]];

/** @type {[string, string][]} */
const COLORS = [["class", "Colours of classes"], ["instance", "Colours of instances"], ["part", "Colours of parts"], ["plain", "White"]];

/** @param {import("./space.js").Space} space @param {boolean} open */
export function spaceControls(space, open) {
    const { scene } = space.session;
    const missing = /** @type {Partial<Record<SpacePart, boolean>>} */ ({ surfaces: !scene?.has_geometry, free: !scene?.has_space, occupied: !scene?.has_space });
    const box = ([part, label] = PARTS[0]) => el("label", {}, el("input", { type: "checkbox", "data-part": part, checked: space.on[part] && !missing[part], disabled: !!missing[part],
        onchange: (/** @type {any} */ event) => space.turn(part, event.target.checked) }), ` ${label}`);
    const colors = el("select", { "aria-label": "Colours of the surfaces", onchange: (/** @type {any} */ event) => space.color(event.target.value) },
        ...COLORS.map(([value, text]) => el("option", { value, selected: value === space.coloring }, text)));
    return el("details", { class: "space-controls panel", open }, el("summary", {}, "Scene"), ...PARTS.map(box), colors,
        el("button", { type: "button", title: "V", onclick: () => space.toFrame() }, "Through this frame's camera"),
        el("button", { type: "button", title: "G", onclick: () => space.fromAbove() }, "From above"));
}
