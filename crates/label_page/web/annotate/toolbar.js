// The tools at the left and the buttons at the top. Their buttons run commands of the table.

import { byId, el } from "../shared/dom.js";
import { oneTabStop } from "../shared/one_tab_stop.js";
import { keyName } from "./commands.js";
import { FILTERS } from "./filters.js";

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
export function commandButton(state, table, id, text, pressed = null) {
    const command = table.get(id);
    if (!command) throw new Error(`no command "${id}"`);
    const key = command.keys[0] ? keyName(command.keys[0]) : "";
    const made = el("button", { "data-command": id, title: `${command.name} (${key})`, "aria-keyshortcuts": command.keys[0] === " " ? "Space" : command.keys[0].replace("Ctrl", "Control"), onclick: command.run }, text);
    if (pressed) state.on(["tools", "painting", "view", "visibility", "selection"], () => made.setAttribute("aria-pressed", String(pressed())));
    return made;
}

/** @param {State} state @param {Map<string, Command>} table */
export function toolbar(state, table) {
    /** @param {string} legend @param {...Node} children */
    const group = (legend, ...children) => el("fieldset", {}, el("legend", {}, legend), ...children);
    /** @param {string} id @param {string} text @param {(() => boolean) | null} [pressed] */
    const keyed = (id, text, pressed = null) => {
        const made = commandButton(state, table, id, text, pressed);
        made.append(el("kbd", { "aria-hidden": "true" }, keyName(table.get(id)?.keys[0] ?? "")));
        return made;
    };
    const tools = [["pen", "Pen"], ["line", "Line"], ["rectangle", "Rectangle"], ["eyedropper", "Eyedropper"]].map(([tool, text]) => keyed(`tool-${tool}`, text, () => state.drawMode && state.tool === tool));
    const layer = ["instance", "semantic"].map((name) => {
        const made = el("button", { "data-layer": name, title: "Layer to label and to show (T)", onclick: () => state.set({ layer: name }) }, name === "instance" ? "Instance" : "Class");
        state.on(["tools"], () => made.setAttribute("aria-pressed", String(state.layer === name)));
        return made;
    });
    const expands = ["piece", "instance", "class"].map((name) => keyed(`expand-${name}`, name === "piece" ? "Piece" : name === "instance" ? "Instance" : "Class", () => state.expand === name));
    const filters = FILTERS.map(([filter, text]) => {
        const box = el("input", { type: "checkbox", "data-filter": filter, onchange: () => state.setFilter(filter, box.checked) });
        state.on(["filters", "tools"], () => {
            box.checked = state.filtersNow[filter];
            box.disabled = state.tool === "eyedropper";
        });
        return el("label", {}, box, text);
    });
    byId("tools").append(
        group("Layer", el("div", { class: "pair" }, ...layer)),
        group("Tool", keyed("select", "Select", () => !state.drawMode), ...tools),
        group("Mode", keyed("erase", "Erase", () => (state.painting ? state.painting.erase : state.erase)), keyed("unique", "Unique ids", () => state.unique), keyed("new-instance", "New instance"), keyed("go-on", "Go on", () => state.goesOn)),
        group("Expand to whole", ...expands),
        group("Only faces", ...filters),
    );
    oneTabStop(byId("tools"));
}

/** @param {State} state @param {Map<string, Command>} table @param {import("./actions.js").Actions} act */
export function topBar(state, table, act) {
    const { looking } = act;
    const button = (/** @type {string} */ id, /** @type {string} */ text, /** @type {(() => boolean) | null} */ pressed = null) => commandButton(state, table, id, text, pressed);
    const undo = button("undo", "↶");
    const redo = button("redo", "↷");
    undo.setAttribute("aria-label", "Undo");
    redo.setAttribute("aria-label", "Redo");
    byId("history").append(undo, redo);
    state.on(["history"], () => {
        const own = state.own(act.edits.who);
        undo.disabled = own.undo === null;
        redo.disabled = own.redo === null;
        undo.title = own.undo === null ? "You have nothing to undo" : `Undo: ${own.undo} (Ctrl+Z)`;
        redo.title = own.redo === null ? "You have nothing to redo" : `Redo: ${own.redo} (Ctrl+Shift+Z)`;
    });
    const realLook = button("real-look", "Real look", () => act.realLook.on);
    realLook.disabled = !act.realLook.isKnown;
    if (realLook.disabled) realLook.title = "The scene has neither materials nor pictures";
    byId("view-buttons").append(
        button("whole-scene", "All"),
        button("from-above", "Above"),
        realLook,
        button("ceilings", "Hide ceilings", () => looking.ceilings !== null),
        button("xray", "X-ray", () => state.selection.size > 0 && [...state.selection].every((piece) => state.xray.has(piece))),
        button("isolate", "Isolate", () => state.isolated),
        button("hide", "Hide"),
        button("show-all", "Show all"),
    );
    for (const [id, sign, label] of [["settings", "⚙", "Camera and scene"], ["theme", "◐", "Dark or light"], ["help", "?", "Keys"]]) {
        const made = button(id, sign);
        made.setAttribute("aria-label", label);
        byId("page-buttons").append(made);
    }
    const cameras = byId("cameras");
    cameras.hidden = false;
    cameras.append(el("option", { value: "-1" }, looking.frames.length > 0 ? "Camera: free" : "No planned camera"));
    looking.frames.forEach((/** @type {any} */ frame, /** @type {number} */ i) => cameras.append(el("option", { value: String(i) }, `${frame.camera} · ${frame.frame}`)));
    cameras.addEventListener("change", () => looking.goToFrame(Number(cameras.value)));
    const rooms = byId("rooms");
    rooms.hidden = looking.rooms.length === 0;
    rooms.append(el("option", { value: "-1" }, "All rooms"), ...looking.rooms.map(({ name }, i) => el("option", { value: String(i) }, name)));
    rooms.addEventListener("change", () => looking.goToRoom(Number(rooms.value)));
    state.on(["view"], () => (rooms.value = String(looking.room)));
    oneTabStop(byId("top"));
}
