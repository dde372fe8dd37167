// The values under the cursor: exactly as stored, with unit and type, and the names of the numbers.

import { el } from "../shared/dom.js";
import { exact, pixelOf } from "./numbers.js";
import { NAMING } from "./session.js";

const DTYPES = /** @type {Record<string, string>} */ ({ float16: "f16", float32: "f32", int16: "i16", uint8: "u8" });

/**
 * @param {HTMLElement} element
 * @param {import("./session.js").Session} session
 * @param {import("./session.js").Pixel | null} pixel
 */
export function showReadout(element, session, pixel) {
    const lines = pixel ? session.sides().map((side, i) => layerLine(session, side, pixel, i)) : [el("div", { class: "quiet" }, "Point at the picture to read its values.")];
    while (lines.length < 2) lines.push(el("div"));
    const difference = session.difference();
    lines.push(!pixel ? el("div") : difference ? differenceLine(session, difference, pixel) : namesLine(session, pixel));
    element.replaceChildren(...lines);
}

/**
 * @param {import("./session.js").Session} session
 * @param {import("./session.js").Side} side
 * @param {import("./session.js").Pixel} pixel
 * @param {number} index
 */
function layerLine(session, side, pixel, index) {
    const { frame, layer, data, camera } = side;
    const spec = session.looks.spec(layer);
    const line = el("div", { "data-layer": layer, "data-side": index });
    const place = `${String(pixel.x).padStart(4)}, ${String(pixel.y).padStart(4)}`;
    line.append(el("span", { class: "quiet" }, index === 0 ? `${place}  ` : " ".repeat(12)), el("b", {}, session.looks.title(layer)), el("span", { class: "quiet" }, ` ${camera === session.camera ? "" : `${camera.name} `}#${frame}  `));
    const values = data?.step === 1 ? pixelOf(data, pixel.x, pixel.y) : null;
    if (!data || !values) {
        line.append(el("span", { class: "quiet" }, session.failureOf(side)?.error ?? "…"));
        return line;
    }
    line.append(el("span", { class: "value" }, values.map((value) => exact(value, data.dtype)).join("  ")), el("span", { class: "quiet" }, ` ${spec.unit} ${DTYPES[data.dtype]}`));
    const { kind } = session.looks.look(layer);
    if (kind === "id" || kind === "code") line.append(`  ${session.looks.name(layer, values[0])}`);
    if (spec.space && kind !== "id") line.append(el("span", { class: "quiet" }, `  ${spec.space}`));
    return line;
}

/** @param {import("./session.js").Session} session @param {import("./numbers.js").LayerData} difference @param {import("./session.js").Pixel} pixel */
function differenceLine(session, difference, pixel) {
    const [value] = pixelOf(difference, pixel.x, pixel.y) ?? [];
    const says = difference.summary.of === "share that differs" ? (value ? "differ" : "same") : value === undefined ? "" : `${exact(value, "float32")} ${session.looks.spec(session.store.state.layer).unit}`;
    return el("div", { "data-difference": "" }, " ".repeat(12), el("b", {}, difference.summary.of === "share that differs" ? "compared" : difference.summary.of), "  ", el("span", { class: "value" }, says));
}

/**
 * @param {import("./session.js").Session} session
 * @param {import("./session.js").Pixel} pixel
 */
function namesLine(session, pixel) {
    const side = session.sides()[pixel.side] ?? session.sides()[0];
    const words = { render_entity_id: "part", semantic: "class", semantic_instance: "instance", material_id: "material" };
    const line = el("div", { class: "names" });
    for (const layer of NAMING) {
        const names = side && session.namesOf(side, layer);
        const id = names ? pixelOf(names, pixel.x, pixel.y)?.[0] : undefined;
        if (id === undefined) continue;
        const name = layer === "semantic_instance" && id < 1 ? "none" : session.looks.name(layer, id);
        line.append(el("span", { class: "quiet" }, `${/** @type {any} */ (words)[layer]} `), el("span", { "data-names": layer }, id > 0 ? `${id} ${name}` : name), "   ");
    }
    return line;
}
