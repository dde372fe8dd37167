// The tools at the left, the buttons at the top, and the box of the selection. Their buttons run commands of the table.

import { byId, el } from "../shared/dom.js";
import { css } from "./colors.js";
import { keyName } from "./commands.js";

/** @typedef {import("./commands.js").Command} Command */
/** @typedef {import("./state.js").State} State */

/**
 * A button that runs a command; `pressed` says whether it is on.
 *
 * @param {State} state
 * @param {Map<string, Command>} table
 * @param {string} id
 * @param {string} text
 * @param {(() => boolean) | null} [pressed]
 */
function button(state, table, id, text, pressed = null) {
    const command = table.get(id);
    if (!command) throw new Error(`no command "${id}"`);
    const key = command.keys[0] ? keyName(command.keys[0]) : "";
    const made = el("button", { "data-command": id, title: `${command.name} (${key})`, "aria-keyshortcuts": command.keys[0] === " " ? "Space" : command.keys[0].replace("Ctrl", "Control"), onclick: command.run }, text);
    if (pressed) state.on(["tools", "view", "visibility", "selection"], () => made.setAttribute("aria-pressed", String(pressed())));
    return made;
}

/** @param {State} state @param {Map<string, Command>} table */
export function toolbar(state, table) {
    /** @param {string} legend @param {...Node} children */
    const group = (legend, ...children) => el("fieldset", {}, el("legend", {}, legend), ...children);
    /** @param {string} id @param {string} text @param {() => boolean} pressed */
    const keyed = (id, text, pressed) => {
        const made = button(state, table, id, text, pressed);
        made.append(el("kbd", { "aria-hidden": "true" }, keyName(table.get(id)?.keys[0] ?? "")));
        return made;
    };
    const tools = [["pen", "Pen"], ["line", "Line"], ["rectangle", "Rectangle"], ["eyedropper", "Eyedropper"]].map(([tool, text]) => keyed(`tool-${tool}`, text, () => state.tool === tool));
    const layer = ["instance", "semantic"].map((name) => {
        const made = el("button", { "data-layer": name, title: "Layer to label and to show (T)", onclick: () => state.set({ layer: name }) }, name === "instance" ? "Instance" : "Class");
        state.on(["tools"], () => made.setAttribute("aria-pressed", String(state.layer === name)));
        return made;
    });
    const expands = ["piece", "instance", "class"].map((name) => keyed(`expand-${name}`, name === "piece" ? "Piece" : name === "instance" ? "Instance" : "Class", () => state.expand === name));
    const filters = /** @type {[import("./state.js").Filter, string][]} */ ([["only_without_instance", "without instance"], ["only_with_instance", "with instance"], ["only_without_class", "without class"], ["only_with_class", "with class"]]).map(([filter, text]) => {
        const box = el("input", { type: "checkbox", "data-filter": filter, onchange: () => state.setFilter(filter, box.checked) });
        state.on(["filters", "tools"], () => {
            box.checked = state.filters[filter];
            box.disabled = state.tool === "eyedropper";
        });
        return el("label", {}, box, text);
    });
    const label = el("div", { id: "label-now" });
    state.on(["tools", "labels"], () => {
        const one = state.classById.get(state.currentClass);
        const bySemantic = state.layer === "semantic";
        const swatch = el("span", { class: "swatch" });
        const instance = state.fresh ? "new instance" : `instance ${state.currentInstance}`;
        const color = bySemantic ? one?.color : state.fresh ? null : state.instanceColor(state.currentInstance);
        swatch.style.background = css(color ?? [255, 255, 255]);
        label.replaceChildren(swatch, ` ${state.erase ? "no label" : bySemantic ? one?.name ?? "" : state.unique ? "new id each" : instance}`);
    });
    byId("tools").append(
        group("Label to give", label, button(state, table, "new-instance", "New instance")),
        group("Layer", el("div", { class: "pair" }, ...layer)),
        group("Tool", ...tools),
        group("Mode", keyed("draw-mode", "Draw", () => state.drawMode), keyed("erase", "Erase", () => state.erase), keyed("unique", "Unique ids", () => state.unique)),
        group("Expand to whole", ...expands),
        group("Only faces", ...filters),
    );
}

/** @param {State} state @param {Map<string, Command>} table @param {import("./actions.js").Actions} act */
export function topBar(state, table, act) {
    const undo = button(state, table, "undo", "Undo");
    const redo = button(state, table, "redo", "Redo");
    byId("history").append(undo, redo);
    state.on(["history"], () => {
        const { can_undo, can_redo, undo_description, redo_description } = state.standing;
        undo.disabled = !can_undo;
        redo.disabled = !can_redo;
        undo.title = can_undo ? `Undo: ${undo_description ?? ""} (Ctrl+Z)` : "Nothing to undo";
        redo.title = can_redo ? `Redo: ${redo_description ?? ""} (Ctrl+Shift+Z)` : "Nothing to redo";
    });
    byId("view-buttons").append(
        button(state, table, "xray", "X-ray", () => state.selection.size > 0 && [...state.selection].every((piece) => state.xray.has(piece))),
        button(state, table, "isolate", "Isolate", () => state.isolated),
        button(state, table, "hide", "Hide"),
        button(state, table, "show-all", "Show all"),
        button(state, table, "wireframe", "Wireframe", () => act.wireframe),
    );
    for (const [id, sign, label] of [["settings", "⚙", "Camera and scene"], ["theme", "◐", "Dark or light"], ["help", "?", "Keys"]]) {
        const made = button(state, table, id, sign);
        made.setAttribute("aria-label", label);
        byId("page-buttons").append(made);
    }
    const cameras = byId("cameras");
    cameras.append(el("option", { value: "-1" }, act.frames.length > 0 ? "free" : "none planned"));
    act.frames.forEach((/** @type {any} */ frame, /** @type {number} */ i) => cameras.append(el("option", { value: String(i) }, `${frame.camera} · ${frame.frame}`)));
    cameras.addEventListener("change", () => act.goToFrame(Number(cameras.value)));
    const pace = byId("decimation");
    pace.addEventListener("change", () => {
        act.stage.pace.fixed = pace.value === "auto" ? null : pace.value === "all" ? Infinity : Number(pace.value);
    });
}

/** What is selected, and what can be done with it. @param {State} state @param {Map<string, Command>} table */
export function selectionBox(state, table) {
    const what = el("div", { class: "what" });
    const more = el("div", { class: "what quiet" });
    const names = /** @type {[string, string][]} */ ([["assign", "Assign"], ["confirm", "Confirm"], ["same-name", "Same name"], ["same-geometry", "Same shape"], ["split-component", "Split"], ["split-faces", "Paint"]]);
    const buttons = names.map(([id, text]) => button(state, table, id, text));
    byId("current").append(what, more, el("div", { class: "row" }, ...buttons));
    state.on(["selection", "labels"], () => {
        const pieces = [...state.selection];
        const area = pieces.reduce((sum, piece) => sum + state.pieces.areas_m2[piece], 0);
        const [first] = pieces;
        const one = pieces.length === 1;
        what.textContent = pieces.length === 0 ? "Nothing selected" : one ? state.name(first) : `${pieces.length} pieces, ${area.toFixed(2)} m²`;
        const { instance, materials, suggestions } = state.pieces;
        const hint = one && suggestions[first] ? `, suggested ${state.classById.get(suggestions[first].semantic)?.name}` : "";
        more.textContent = one ? `${state.className(first) || "no class"}, ${instance[first] >= 1 ? `instance ${instance[first]}` : "no instance"}, ${materials[first]}${hint}` : pieces.length === 0 ? "Click a piece, or press . for the next unlabelled" : "";
        for (const made of buttons) made.disabled = pieces.length === 0;
    });
}
