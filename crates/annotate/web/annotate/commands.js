// All commands in one table: name, keys and action. The help overlay, the palette and the keyboard use it.

/**
 * @typedef {object} Command
 * @property {string} id
 * @property {string} group
 * @property {string} name
 * @property {string[]} keys such as "p", "Ctrl+z", "Shift+h", " "; "Ctrl" is also the Mac's command key
 * @property {() => void} run
 */

/** Keys that are no commands, for the help. */
export const GESTURES = [
    ["Left drag", "turn about the look-at point"],
    ["Right drag", "move sideways"],
    ["Wheel", "nearer or farther"],
    ["Double click", "look at this point"],
    ["W A S D, R F", "fly; up and down"],
    ["Click, Ctrl+click", "select; add to the selection"],
    ["Shift+left drag", "draw (in draw mode: move the camera)"],
    ["Shift+right click", "new instance"],
    ["Digits", "class by its number"],
];

/**
 * @param {import("./actions.js").Actions} act
 * @returns {Command[]}
 */
export function commands(act) {
    const { state } = act;
    /** @type {Command[]} */
    const table = [];
    /** @param {string} group @param {[string, string, string[], () => void][]} rows */
    const add = (group, rows) => table.push(...rows.map(([id, name, keys, run]) => ({ id, group, name, keys, run })));
    add("Tools", [
        ["tool-pen", "Pen", ["p"], () => state.set({ tool: "pen" })],
        ["tool-line", "Line", ["l"], () => state.set({ tool: "line" })],
        ["tool-rectangle", "Rectangle", ["b"], () => state.set({ tool: "rectangle" })],
        ["tool-eyedropper", "Eyedropper", ["i"], () => state.set({ tool: "eyedropper" })],
        ["erase", "Erase", ["e"], () => state.set({ erase: !state.erase })],
        ["unique", "Unique instance ids", ["u"], () => state.set({ unique: !state.unique })],
        ["draw-mode", "Draw mode: a plain drag draws", ["g"], () => state.set({ drawMode: !state.drawMode })],
        ["new-instance", "New instance", [" "], () => act.newInstance()],
    ]);
    add("Layers", [
        ["layer", "Other layer: instance or class", ["t"], () => state.set({ layer: state.layer === "semantic" ? "instance" : "semantic" })],
        ["expand-piece", "Expand to pieces", ["Alt+1"], () => state.set({ expand: "piece" })],
        ["expand-instance", "Expand to whole instances", ["Alt+2"], () => state.set({ expand: "instance" })],
        ["expand-class", "Expand to whole classes", ["Alt+3"], () => state.set({ expand: "class" })],
        ["filter-1", "Filter: only without instance", ["Alt+4"], () => state.setFilter("only_without_instance", !state.filters.only_without_instance)],
        ["filter-2", "Filter: only with instance", ["Alt+5"], () => state.setFilter("only_with_instance", !state.filters.only_with_instance)],
        ["filter-3", "Filter: only without class", ["Alt+6"], () => state.setFilter("only_without_class", !state.filters.only_without_class)],
        ["filter-4", "Filter: only with class", ["Alt+7"], () => state.setFilter("only_with_class", !state.filters.only_with_class)],
    ]);
    add("Selection", [
        ["assign", "Give the selection the current label", ["Enter"], () => act.assign()],
        ["clear-label", "Take the label of this layer away", ["Delete", "Backspace"], () => act.clearLabel()],
        ["confirm", "Confirm the suggestion for the selection", ["y"], () => act.confirmSelection()],
        ["same-name", "Select all with the same name", ["n"], () => act.sameName()],
        ["same-geometry", "Select all with the same geometry", ["j"], () => act.sameGeometry()],
        ["same-instance", "Select all of the same instance", ["Shift+j"], () => act.sameInstance()],
        ["split-component", "Split into connected components", ["k"], () => act.split("component")],
        ["split-material", "Split by material", ["Shift+k"], () => act.split("material")],
        ["split-faces", "Split off painted faces: begin, and split", ["m"], () => act.paint()],
        ["next-unlabelled", "Next unlabelled piece, and look at it", ["."], () => void act.step(1)],
        ["previous-unlabelled", "Unlabelled piece before", [","], () => void act.step(-1)],
        ["look-at-selection", "Look at the selection", ["o"], () => act.frameSelection()],
        ["cancel", "Select nothing; end painting", ["Escape"], () => act.cancel()],
    ]);
    add("View", [
        ["xray", "See through the selection", ["x"], () => act.xray()],
        ["isolate", "Isolate the selection", ["v"], () => act.isolate()],
        ["hide", "Hide the selection", ["h"], () => act.hide()],
        ["show-all", "Show everything", ["Shift+h"], () => state.setVisibility([], [])],
        ["wireframe", "Edges of triangles", ["c"], () => act.toggleWireframe()],
        ["outlines", "Outlines of pieces", ["Shift+c"], () => act.toggleOutlines()],
        ["next-camera", "Next planned camera", ["]"], () => act.stepCamera(1)],
        ["previous-camera", "Planned camera before", ["["], () => act.stepCamera(-1)],
        ["faster", "Fly faster", ["+", "="], () => act.speed(1.5)],
        ["slower", "Fly slower", ["-"], () => act.speed(1 / 1.5)],
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
    return table;
}

/** How a key is written. @param {string} key */
export const keyName = (key) => key.replace(/^ $/, "Space").replace(/\b[a-z]$/, (letter) => letter.toUpperCase());

/** The name of a pressed key, as in the table. @param {KeyboardEvent} event */
export function pressed(event) {
    const letter = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    // With Alt, a digit key may type another character; its code says which digit it is.
    const key = event.altKey && event.code.startsWith("Digit") ? event.code.slice(5) : letter;
    const shift = event.shiftKey && /^[a-z]$/.test(key);
    return `${event.ctrlKey || event.metaKey ? "Ctrl+" : ""}${event.altKey ? "Alt+" : ""}${shift ? "Shift+" : ""}${key}`;
}

/** Time within which two digits make one number, milliseconds. */
const DIGITS_MS = 900;

/**
 * Runs commands by their keys, and classes by digits. Text that is being typed is left alone.
 *
 * @param {Command[]} table
 * @param {import("./actions.js").Actions} act
 */
export function listenToKeys(table, act) {
    const byKey = new Map(table.flatMap((command) => command.keys.map((key) => /** @type {[string, Command]} */ ([key, command]))));
    let [digits, last] = ["", 0];
    window.addEventListener("keydown", (event) => {
        const target = /** @type {HTMLElement} */ (event.target);
        const typing = target.matches?.("input:not([type=checkbox]):not([type=range]), select, textarea") ?? false;
        const name = pressed(event);
        if (document.querySelector("dialog[open]")) return;
        if (typing && !name.startsWith("Ctrl+k") && !name.startsWith("Ctrl+s")) {
            if (name === "Escape") target.blur();
            return;
        }
        // A focused control keeps the keys that operate it.
        if ((name === " " || name === "Enter") && target.closest("button, [role=tab], summary, a, input")) return;
        if (/^\d$/.test(name)) {
            digits = event.timeStamp - last < DIGITS_MS ? digits + name : name;
            last = event.timeStamp;
            act.classByNumber(Number(digits));
            return;
        }
        const command = byKey.get(name);
        if (command) {
            event.preventDefault();
            command.run();
        } else if (!event.shiftKey && act.stage.controls.key(event)) {
            event.preventDefault();
        }
    });
}
