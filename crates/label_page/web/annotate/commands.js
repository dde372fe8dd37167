// All commands in one table: name, keys and action. The help overlay, the palette and the keyboard use it.

import { CLIP_STEP_M } from "./looking.js";

/**
 * @typedef {object} Command
 * @property {string} id
 * @property {string} group
 * @property {string} name
 * @property {string[]} keys such as "p", "Ctrl+z", "Shift+h", " "; "Ctrl" is also the Mac's command key
 * @property {() => void} run
 * @property {boolean} [held] true when holding the key takes the command back at its end
 */

/** Keys that are no commands, for the help. */
export const GESTURES = [
    ["Left drag", "turn about the look-at point; with a tool: draw"],
    ["Right drag", "move sideways"],
    ["Wheel", "nearer or farther"],
    ["Double click", "look at this point"],
    ["W A S D, R F", "fly; up and down"],
    ["Arrows, Shift+arrows", "turn about the look-at point; on the spot"],
    ["Click, Ctrl+click", "select; add to the selection"],
    ["Shift+left drag", "draw; with a tool: move the camera"],
    ["Shift+right click", "new instance"],
    ["Digits", "class by its number; any other key ends it"],
];

/**
 * @param {import("./actions.js").Actions} act
 * @returns {Command[]}
 */
export function commands(act) {
    const { state, looking } = act;
    /** @type {Command[]} */
    const table = [];
    /** @param {string} group @param {[string, string, string[], () => void][]} rows */
    const add = (group, rows) => table.push(...rows.map(([id, name, keys, run]) => ({ id, group, name, keys, run })));
    add("Tools", [
        ["select", "Select, and move the camera; back to the tool", ["g"], () => act.toggleDrawing()],
        ["tool-pen", "Pen", ["p"], () => act.chooseTool("pen")],
        ["tool-line", "Line", ["l"], () => act.chooseTool("line")],
        ["tool-rectangle", "Rectangle", ["b"], () => act.chooseTool("rectangle")],
        ["tool-eyedropper", "Eyedropper, for one click", ["i"], () => act.chooseTool("eyedropper")],
        ["erase", "Erase: press to switch, or hold", ["e"], () => act.toggleErase()],
        ["unique", "Unique instance ids", ["u"], () => state.set({ unique: !state.unique })],
        ["new-instance", "New instance", [" "], () => act.newInstance()],
        ["go-on", "After each label, go to the next piece", ["Shift+g"], () => state.toggleGoingOn()],
    ]);
    add("Layers", [
        ["layer", "Other layer: instance or class", ["t"], () => state.set({ layer: state.layer === "semantic" ? "instance" : "semantic" })],
        ["expand-piece", "Expand to pieces", ["Alt+1"], () => state.set({ expand: "piece" })],
        ["expand-instance", "Expand to whole instances", ["Alt+2"], () => state.set({ expand: "instance" })],
        ["expand-class", "Expand to whole classes", ["Alt+3"], () => state.set({ expand: "class" })],
        ["filter-1", "Filter: only without instance", ["Alt+4"], () => state.setFilter("only_without_instance", !state.filtersNow.only_without_instance)],
        ["filter-2", "Filter: only with instance", ["Alt+5"], () => state.setFilter("only_with_instance", !state.filtersNow.only_with_instance)],
        ["filter-3", "Filter: only without class", ["Alt+6"], () => state.setFilter("only_without_class", !state.filtersNow.only_without_class)],
        ["filter-4", "Filter: only with class", ["Alt+7"], () => state.setFilter("only_with_class", !state.filtersNow.only_with_class)],
    ]);
    add("Selection", [
        ["assign", "Give the selection the current label", ["Enter"], () => act.assign()],
        ["thing", "New thing: class and new instance, then go to the next", ["Shift+Enter"], () => void act.makeThing()],
        ["whole", "Select the whole object; again: the one around it", ["Shift+w"], () => act.things.selectWhole()],
        ["whole-thing", "The whole object: class and new instance, then go to the next", ["Ctrl+Enter"], () => void act.things.makeWhole()],
        ["same-again", "The same again: label all copies, moved or mirrored, an instance each", ["Shift+s"], () => void act.things.sameAgain()],
        ["clear-label", "Remove the label of this layer", ["Delete", "Backspace"], () => act.clearLabel()],
        ["confirm", "Confirm the suggestion for the selection", ["y"], () => act.confirmSelection()],
        ["reject", "Reject the suggestion for the selection", ["Shift+y"], () => act.withSelection((pieces) => state.reject(pieces))],
        ["same-name", "Select all with the same name", ["n"], () => act.sameName()],
        ["same-geometry", "Select all with the same geometry", ["j"], () => act.sameGeometry()],
        ["same-instance", "Select all of the same instance", ["Shift+j"], () => act.sameInstance()],
        ["split-component", "Split into connected components", ["k"], () => act.split("component")],
        ["split-material", "Split by material", ["Shift+k"], () => act.split("material")],
        ["split-faces", "Split off painted faces: begin, and split", ["m"], () => act.paint()],
        ["next-unlabelled", "Next unlabelled piece, and look at it", ["."], () => act.step(1)],
        ["previous-unlabelled", "Unlabelled piece before", [","], () => act.step(-1)],
        ["look-at-selection", "Look at the selection", ["o"], () => act.withSelection((pieces) => looking.lookAt(pieces))],
        ["cancel", "Step back: end painting, drawing, select nothing", ["Escape"], () => act.cancel()],
    ]);
    add("Review", [
        ["done", "Done", ["Shift+d"], () => void act.review("done")],
        ["approve", "Approved", ["Shift+a"], () => void act.review("approved")],
        ["question", "Question, with a note", ["Shift+q"], () => act.withSelection((pieces) => act.openQuestion(pieces.length === 1 ? state.name(pieces[0]) : `${pieces.length} pieces`))],
        ["to-do", "To do again", ["Shift+z"], () => void act.review("to_do")],
    ]);
    add("View", [
        ["xray", "See through the selection", ["x"], () => act.withSelection((pieces) => looking.xray(pieces))],
        ["isolate", "Isolate the selection", ["v"], () => (state.isolated ? looking.isolate([]) : act.withSelection((pieces) => looking.isolate(pieces)))],
        ["hide", "Hide the selection", ["h"], () => act.withSelection((pieces) => looking.hide(pieces))],
        ["show-all", "Show everything", ["Shift+h"], () => looking.showAll()],
        ["real-look", "Real look or labels", ["Shift+r"], () => void act.realLook.toggle()],
        ["ceilings", "Hide ceilings", ["q"], () => looking.toggleCeilings()],
        ["whole-scene", "Whole scene", ["Home"], () => looking.wholeScene()],
        ["from-above", "Whole scene from above, without ceilings", ["End"], () => looking.fromAbove()],
        ["clip", "Show only what is around the selection, in a clip box", ["Shift+b"], () => act.withSelection((pieces) => looking.clipTo(pieces))],
        ["clip-lower", "Clip box: lower its top", ["PageDown"], () => looking.moveTop(-CLIP_STEP_M)],
        ["clip-higher", "Clip box: raise its top", ["PageUp"], () => looking.moveTop(CLIP_STEP_M)],
        ["clip-farther", "Clip box: push the side that faces you away", ["Shift+PageDown"], () => looking.moveNearSide(-CLIP_STEP_M)],
        ["clip-nearer", "Clip box: pull the side that faces you nearer", ["Shift+PageUp"], () => looking.moveNearSide(CLIP_STEP_M)],
        ["wireframe", "Edges of triangles", ["c"], () => looking.toggleWireframe()],
        ["outlines", "Outlines of pieces", ["Shift+c"], () => looking.toggleOutlines()],
        ["next-camera", "Next planned camera", ["]"], () => looking.stepCamera(1)],
        ["previous-camera", "Planned camera before", ["["], () => looking.stepCamera(-1)],
        ["faster", "Fly faster", ["+", "="], () => looking.speed(1.5)],
        ["slower", "Fly slower", ["-"], () => looking.speed(1 / 1.5)],
        ["reset-look-at", "Turn about a point 2 m ahead", ["z"], () => act.stage.controls.resetLookAt(2)],
        ["settings", "Camera and scene: speed, near plane, numbers", ["Shift+v"], () => act.openSettings()],
        ["theme", "Dark or light", ["Shift+t"], () => act.toggleTheme()],
    ]);
    add("Edits", [
        ["undo", "Undo", ["Ctrl+z"], () => void act.edits.send({ type: "undo" })],
        ["redo", "Redo", ["Ctrl+Shift+z", "Ctrl+y"], () => void act.edits.send({ type: "redo" })],
        ["save", "Write Hypersim's files now", ["Ctrl+s"], () => void act.save()],
        ["search-pieces", "Search pieces", ["/"], () => act.focusSearch("pieces")],
        ["search-classes", "Search classes", ["\\"], () => act.focusSearch("classes")],
        ["palette", "All commands", ["Ctrl+k"], () => act.openPalette()],
        ["help", "Keys", ["?"], () => act.openHelp()],
    ]);
    return table.map((command) => (command.id === "erase" ? { ...command, held: true } : command));
}

/** Choosing a class by its name, for the palette. @param {import("./actions.js").Actions} act @returns {Command[]} */
export const classCommands = (act) => act.state.classes.map(({ id, name }) => ({ id: `class-${id}`, group: "Class", name, keys: [...String(id)], run: () => act.chooseClass(id) }));

/** How a key is written. @param {string} key */
export const keyName = (key) => key.replace(/^ $/, "Space").replace(/\b[a-z]$/, (letter) => letter.toUpperCase());

/** The name of a pressed key, as in the table. @param {KeyboardEvent} event */
export function pressed(event) {
    const letter = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    // With Alt, a digit key may type another character; its code says which digit it is.
    const key = event.altKey && event.code.startsWith("Digit") ? event.code.slice(5) : letter;
    const shift = event.shiftKey && /^([a-z]|Enter|PageUp|PageDown)$/.test(key);
    return `${event.ctrlKey || event.metaKey ? "Ctrl+" : ""}${event.altKey ? "Alt+" : ""}${shift ? "Shift+" : ""}${key}`;
}

/** A key that is held longer than this takes its command back when it is released, milliseconds. */
const HOLD_MS = 350;
/** Commands that a held key does again and again. */
const REPEATED = new Set(["undo", "redo", "next-unlabelled", "previous-unlabelled", "next-camera", "previous-camera", "faster", "slower", "clip-lower", "clip-higher", "clip-farther", "clip-nearer"]);

/** True when a control needs this key itself. @param {HTMLElement} target @param {string} name */
const operates = (target, name) => (name === " " || name === "Enter") && target.closest("button, [role=tab], summary, a, input, select") !== null;

/**
 * Runs commands by their keys, and classes by digits. Text that is being typed is left alone.
 *
 * @param {Command[]} table
 * @param {import("./actions.js").Actions} act
 */
export function listenToKeys(table, act) {
    const byKey = new Map(table.flatMap((command) => command.keys.map((key) => /** @type {[string, Command]} */ ([key, command]))));
    window.addEventListener("pointerdown", () => act.digits.end(), { capture: true });
    window.addEventListener("keydown", (event) => {
        const target = /** @type {HTMLElement} */ (event.target);
        const typing = target.matches?.("input:not([type=checkbox]):not([type=range]), select, textarea") ?? false;
        const name = pressed(event);
        if (event.defaultPrevented || document.querySelector("dialog[open]")) return;
        if (typing && !name.startsWith("Ctrl+k") && !name.startsWith("Ctrl+s")) {
            if (name === "Escape") act.stage.element.focus();
            return;
        }
        // Enter after digits is meant for the label, whatever has the focus.
        const numbered = act.digits.typed !== "";
        if (act.digits.key(name)) return event.preventDefault();
        if (operates(target, name) && !numbered) return;
        const command = byKey.get(name);
        if (command) {
            event.preventDefault();
            if (!event.repeat || REPEATED.has(command.id)) command.run();
        } else if ((!event.shiftKey || event.key.startsWith("Arrow")) && act.stage.controls.key(event)) {
            event.preventDefault();
            act.tellView();
        }
    });
    holdKeys(byKey);
}

/** Takes commands back when their key was held. @param {Map<string, Command>} byKey */
function holdKeys(byKey) {
    /** @type {Map<string, { command: Command, at: number }>} */
    const down = new Map();
    const release = (/** @type {string} */ code) => {
        const held = down.get(code);
        if (held && performance.now() - held.at > HOLD_MS) held.command.run();
        down.delete(code);
    };
    window.addEventListener("keydown", (event) => {
        const command = byKey.get(pressed(event));
        if (command?.held && event.defaultPrevented && !down.has(event.code)) down.set(event.code, { command, at: performance.now() });
    });
    window.addEventListener("keyup", (event) => release(event.code));
    window.addEventListener("blur", () => [...down.keys()].forEach(release));
}
