// The annotation page: loads the scene, makes the parts of the page and connects them.

import { getBytes, getJson, postJson } from "../shared/api.js";
import { byId } from "../shared/dom.js";
import { readGeometry } from "../shared/stage3d/geometry.js";
import { resizable } from "../shared/resizable.js";
import { say } from "../shared/say.js";
import { Stage3d } from "../shared/stage3d/stage.js";
import { takeChosenTheme, themeColor } from "../shared/theme.js";
import { toast, toastError } from "../shared/toast.js";
import { Actions } from "./actions.js";
import { classesPanel } from "./classes_panel.js";
import { pieceColors } from "./colors.js";
import { classCommands, commands, listenToKeys } from "./commands.js";
import { Draw } from "./draw.js";
import { counted, Edits } from "./edits.js";
import { focusReturnsTo } from "./focus.js";
import { helpOverlay, palette } from "./help.js";
import { historyPanel } from "./history_panel.js";
import { keep, takeUp } from "./kept.js";
import { tabs } from "./panels.js";
import { called } from "./person.js";
import { piecesPanel } from "./pieces_panel.js";
import { progressPanel, unlabelledPanel } from "./progress_panel.js";
import { selectionBox } from "./selection_box.js";
import { questionDialog } from "./question_dialog.js";
import { State } from "./state.js";
import { settingsDialog } from "./settings.js";
import { suggestionsPanel } from "./suggestions_panel.js";
import { toolbar, topBar } from "./toolbar.js";

/** So many faces are loaded first, the largest ones, for a page that works soon over a slow connection. */
const FIRST_FACES = 24_000;
/** How often activity is reported to the server, milliseconds. */
const ACTIVITY_MS = 15_000;
/** Progress is asked for this long after the last edit, milliseconds. */
const PROGRESS_AFTER_MS = 700;

/** Gives the view the colours of the theme. @param {Stage3d} stage */
function takeTheme(stage) {
    stage.setTheme({ background: themeColor("--ground"), accent: themeColor("--select"), paint: themeColor("--warn") });
}

/** Shows colours, marks and what is hidden as the state says. @param {Stage3d} stage @param {State} state */
function showState(stage, state) {
    state.on(["labels", "layer", "pieces", "proposed"], () => {
        const { rgb, hatched } = pieceColors(state);
        stage.setPieceColors(rgb, hatched);
    });
    state.on(["selection"], () => stage.setMarks(state.selection));
    state.on(["visibility"], () => stage.setVisibility(state.hidden, state.xray));
    state.on(["theme"], () => takeTheme(stage));
    matchMedia("(prefers-color-scheme: light)").addEventListener("change", () => takeTheme(stage));
    state.on(["drawMode", "painting"], () => stage.element.classList.toggle("drawing", state.drawMode || state.painting !== null));
    state.on(["tools", "painting"], () => {
        const words = modeWords(state);
        byId("mode").hidden = words === "";
        byId("mode").textContent = words;
    });
}

/** What a drag on the view does, where it is not the camera's. @param {State} state */
function modeWords(state) {
    if (state.painting) {
        const { piece, faces, erase } = state.painting;
        return `${faces.size} faces of ${state.name(piece)} painted. Drag to ${erase ? "take out" : "add"} (E: ${erase ? "add" : "take out"}), Enter splits them off, Escape ends.`;
    }
    if (!state.drawMode) return "";
    if (state.tool === "eyedropper") return "Click what has the label to take. Escape ends.";
    return `Drag to ${state.erase ? "erase" : "label"} with the ${state.tool}; Shift+drag moves the camera, Escape ends.`;
}

/** Shows whether edits are saved, and applies changes. @param {State} state @param {Edits} edits @param {Stage3d} stage @param {Actions} act */
function followEdits(state, edits, stage, act) {
    const saved = byId("save-state");
    const show = () => {
        const words = { saved: "All saved", saving: "Saving", offline: edits.queue.length > 0 ? `${counted(edits.queue.length)} unsaved` : "Not connected", refused: "Last edit refused" };
        if (saved.textContent !== words[edits.state]) saved.textContent = words[edits.state];
        saved.className = { saved: "good", saving: "quiet", offline: "bad", refused: "bad" }[edits.state];
        byId("offline").hidden = !edits.offline;
        byId("offline").textContent = edits.trouble;
    };
    edits.addEventListener("state", show);
    show();
    let timer = 0;
    const progressSoon = () => {
        clearTimeout(timer);
        timer = setTimeout(() => void act.progress().catch(() => {}), PROGRESS_AFTER_MS);
    };
    edits.addEventListener("change", (event) => {
        const change = /** @type {CustomEvent} */ (event).detail;
        if (change.revision > state.revision + 1) return edits.reload();
        if (!state.takeChange(change)) return;
        const [faces, pieces] = change.moved_faces ?? [[], []];
        if (faces.length > 0) {
            stage.moveFaces(faces, pieces);
            act.moved.push([faces, pieces]);
        }
        if ([...change.resized, ...change.removed].some((one) => (one.piece ?? one) === state.painting?.piece)) act.endPainting();
        if (change.client === edits.client) say(change.description);
        else tellOthers(change, edits);
        progressSoon();
    });
    edits.addEventListener("reviews", () => void getJson("/api/annotate/reviews").then((rows) => state.takeReviews(rows)).catch(() => {}));
    edits.listen(() => state.revision);
    void edits.work();
    progressSoon();
}

/** Shows what others do; a message tells whose own edit was undone or done again. @param {any} change @param {Edits} edits */
function tellOthers(change, edits) {
    const line = byId("others");
    line.textContent = line.title = `${called(change.who, edits.who)}: ${change.description}`;
    if (change.of === edits.who) toast(`${line.textContent}.`, "The history lists every edit, and goes back and forward.");
}

/** Reports activity to the server, which counts the time at work. */
function reportActivity() {
    let last = performance.now();
    for (const kind of ["pointermove", "pointerdown", "keydown", "wheel"]) window.addEventListener(kind, () => (last = performance.now()), { passive: true, capture: true });
    setInterval(() => {
        const idle = (performance.now() - last) / 1000;
        if (idle * 1000 < ACTIVITY_MS) postJson("/api/annotate/activity", { seconds_since_last_input: idle }).catch(() => {});
    }, ACTIVITY_MS);
}

/** Name of what is under the pointer, and where the camera is. @param {Stage3d} stage @param {State} state */
function readOuts(stage, state) {
    const readout = byId("readout");
    const write = () => {
        const at = stage.camera.position.toArray().map((v) => v.toFixed(2)).join(", ");
        readout.textContent = `camera ${at} m · ${stage.camera.fov.toFixed(0)}° · ${stage.controls.speed.toFixed(1)} m/s · ${state.scene.faces.toLocaleString("en")} faces`;
    };
    stage.addEventListener("camera", write);
    state.on(["view"], write);
    let hovered = -1;
    const name = () => {
        if (hovered >= state.count) hovered = -1;
        byId("hover").hidden = hovered < 0;
        if (hovered >= 0) byId("hover").textContent = [state.name(hovered), state.className(hovered) || "no class", state.pieces.instance[hovered] >= 1 ? `instance ${state.pieces.instance[hovered]}` : ""].filter(Boolean).join(" · ");
    };
    state.on(["labels", "pieces"], name);
    return (/** @type {number} */ piece) => {
        hovered = piece;
        name();
    };
}

/** Goes where the address says: `#camera=NAME:FRAME&piece=NUMBER`, else to the first planned camera. @param {import("./looking.js").Looking} looking @param {Stage3d} stage @param {State} state */
function followAddress(looking, stage, state) {
    const words = new URLSearchParams(location.hash.slice(1));
    const [camera, frame] = (words.get("camera") ?? "").split(":");
    const planned = looking.frames.findIndex((/** @type {any} */ one) => one.camera === camera && String(one.frame) === (frame ?? "0"));
    if (planned >= 0) looking.goToFrame(planned);
    else if (state.scene.start_camera) stage.goTo(state.scene.start_camera, { instant: true });
    const piece = Number(words.get("piece") ?? -1);
    if (!words.has("piece") || !(piece < state.count)) return;
    if (planned >= 0) state.select([piece]);
    else looking.goToPiece(piece);
}

/** The panels at the side, and the dialogs. @param {Actions} act @param {import("./commands.js").Command[]} table @param {Map<string, import("./commands.js").Command>} byName */
function panelsAndDialogs(act, table, byName) {
    const { state, stage, edits } = act;
    act.showTab = tabs([
        { name: "classes", title: "Classes", element: classesPanel(state, act) },
        { name: "pieces", title: "Pieces", element: piecesPanel(state, act) },
        { name: "suggestions", title: "Suggested", element: suggestionsPanel(state, act) },
        { name: "unlabelled", title: "To do", element: unlabelledPanel(state, act, byName) },
        { name: "history", title: "History", element: historyPanel(state, edits) },
        { name: "progress", title: "Progress", element: progressPanel(state) },
    ]);
    act.openHelp = helpOverlay(table);
    act.openSettings = settingsDialog(state, stage);
    act.openQuestion = questionDialog((note) => void act.review("question", note));
    act.openPalette = palette([...table, ...classCommands(act)]);
}

/** Loads all faces, where the page began with the most important ones. @param {Stage3d} stage @param {Actions} act */
async function loadRest(stage, act) {
    const bar = byId("rest");
    bar.hidden = false;
    try {
        const geometry = readGeometry(await getBytes("/api/annotate/geometry", { heard: (share) => (byId("rest-share").value = share) }));
        stage.completeGeometry(geometry);
        // They may have been sent before the last splits.
        for (const [faces, pieces] of act.moved) stage.moveFaces(faces, pieces);
        act.realLook.again();
        bar.hidden = true;
    } catch (error) {
        toastError(error);
        byId("rest-words").textContent = "Small faces are missing; reload the page.";
    }
}

async function start() {
    takeChosenTheme();
    // The view first: if the browser cannot show it, nothing needs to be loaded.
    const stage = new Stage3d(byId("stage"));
    const heard = (/** @type {number} */ share) => (byId("loading-share").value = share);
    const [scene, pieces, colors, bytes] = await Promise.all([getJson("/api/annotate/scene"), getJson("/api/annotate/pieces"), getBytes("/api/annotate/instance_colors"), getBytes(`/api/annotate/geometry?most=${FIRST_FACES}`, { heard })]);
    document.title = `${scene.name} - enfilade annotate`;
    byId("scene-name").textContent = scene.name;
    byId("scene-name").title = scene.source;
    const state = new State(scene, pieces, new Uint8Array(colors));
    const edits = new Edits(scene.source);
    const act = new Actions(state, stage, edits);
    const table = commands(act);
    const byName = new Map(table.map((command) => [command.id, command]));
    stage.setGeometry(readGeometry(bytes));
    stage.setOutlines(act.looking.outlines);
    stage.controls.arrowsTurn = true;
    stage.addEventListener("lost", () => toastError(new Error("The browser has taken the graphics away. Reload the page.")));
    toolbar(state, byName);
    topBar(state, byName, act);
    selectionBox(state, byName, act);
    panelsAndDialogs(act, table, byName);
    resizable(byId("side"), "left");
    listenToKeys(table, act);
    showState(stage, state);
    const draw = new Draw(stage, state, { newInstance: () => act.newInstance(), give: (action) => act.give(action), hovered: readOuts(stage, state) });
    act.giveUpStroke = () => draw.giveUp();
    focusReturnsTo(stage.element);
    if (!takeUp(state, stage)) followAddress(act.looking, stage, state);
    keep(state, stage);
    window.addEventListener("hashchange", () => followAddress(act.looking, stage, state));
    followEdits(state, edits, stage, act);
    reportActivity();
    byId("loading").hidden = true;
    if (stage.mesh && stage.mesh.geometry.faces < scene.faces) void loadRest(stage, act);
    // For tests and the console.
    Object.assign(window, { annotate: { state, stage, edits, act } });
}

start().catch((error) => {
    byId("loading").replaceChildren(document.createTextNode(error.message), document.createElement("br"), document.createTextNode(error.help ?? ""));
});
