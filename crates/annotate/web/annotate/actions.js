// What the commands of the annotation page do.

import { getJson, postJson } from "../shared/api.js";
import { byId } from "../shared/dom.js";
import { toast, toastError } from "../shared/toast.js";
import { stem } from "./names.js";
import { newInstance } from "./state.js";

/** The actions of the page, for commands, panels and pointer alike. */
export class Actions {
    /**
     * @param {import("./state.js").State} state
     * @param {import("../shared/stage3d/stage.js").Stage3d} stage
     * @param {import("./edits.js").Edits} edits
     */
    constructor(state, stage, edits) {
        this.state = state;
        this.stage = stage;
        this.edits = edits;
        /** Edits with the current label that the server has not answered yet. @type {Set<any>} */
        this.giving = new Set();
        /** @type {{ piece: number, best_view: { camera: string, frame: number } | null, pixels: number, name: string }[]} */
        this.unlabelled = [];
        this.wireframe = false;
        this.outlines = true;
        this.camera = -1;
        this.openHelp = () => {};
        this.openPalette = () => {};
        this.openSettings = () => {};
        this.showTab = (/** @type {string} */ _name) => {};
        /** All planned frames, in order. */
        this.frames = state.scene.cameras.flatMap((/** @type {any} */ camera) => camera.frames.map((/** @type {any} */ frame) => ({ ...frame, camera: camera.name })));
        // This runs before the next edit of the queue is sent, which may have to use the same new instance number.
        edits.addEventListener("change", (event) => {
            const answered = [...this.giving].find((edit) => !edits.queue.some(({ action }) => action === edit));
            if (answered) this.given(answered, /** @type {CustomEvent} */ (event).detail);
        });
    }

    /** Sends an edit that gives the current label. @param {any} action the edit without `apply` */
    async give(action) {
        const edit = { ...action, apply: this.state.apply };
        this.giving.add(edit);
        this.given(edit, await this.edits.send(edit));
    }

    /** Takes the answer to an edit: if it asked for a new instance and changed something, the answer has the number. @param {any} edit @param {any} change null where it was refused */
    given(edit, change) {
        if (this.giving.delete(edit) && edit.apply.new && change?.pieces.length > 0) this.state.number(edit.apply, change.instance[0]);
    }

    /** The selection; null if it is empty, which the user is told. @returns {number[] | null} */
    chosen() {
        if (this.state.selection.size > 0) return [...this.state.selection];
        toast("Nothing is selected.", "Click a piece in the view or in the list, or press the dot for the next unlabelled one.");
        return null;
    }

    async assign() {
        if (this.state.painting) return void (await this.paint());
        const pieces = this.chosen();
        if (pieces) await this.give({ type: "assign", pieces });
    }

    async clearLabel() {
        const pieces = this.chosen();
        if (pieces) await this.edits.send({ type: "assign", pieces, apply: { layer: this.state.layer, value: -1 } });
    }

    /** Confirms suggestions, in one step. @param {number[]} pieces */
    async confirm(pieces) {
        const known = pieces.filter((piece) => this.state.pieces.suggestions[piece]);
        if (known.length === 0) return toast("There is no suggestion for these pieces.", "Choose a class and press Enter.");
        const semantic = known.map((piece) => this.state.pieces.suggestions[piece].semantic);
        await this.edits.send({ type: "assign_each", pieces: known, semantic });
    }

    confirmSelection() {
        const pieces = this.chosen();
        if (pieces) void this.confirm(pieces);
    }

    newInstance() {
        this.state.set({ layer: "instance", fresh: newInstance(), erase: false });
    }

    /** @param {number} id */
    classByNumber(id) {
        if (this.state.classById.has(id)) this.state.set({ layer: "semantic", currentClass: id, erase: false });
    }

    /** Adds all pieces that have the key of a selected one. @param {(piece: number) => unknown} key */
    alike(key) {
        const pieces = this.chosen();
        if (!pieces) return;
        const keys = new Set(pieces.map(key));
        this.state.select([...Array(this.state.count).keys()].filter((piece) => keys.has(key(piece))));
    }

    sameName() {
        this.alike((piece) => stem(this.state.name(piece)));
    }

    sameGeometry() {
        this.alike((piece) => this.state.pieces.geometry_keys[piece]);
    }

    sameInstance() {
        const { instance } = this.state.pieces;
        this.alike((piece) => (instance[piece] >= 1 ? instance[piece] : `none ${piece}`));
    }

    /** The one selected piece. */
    single() {
        const pieces = this.chosen();
        if (pieces && pieces.length > 1) toast(`${pieces.length} pieces are selected.`, "Select one to split it.");
        return pieces?.length === 1 ? pieces[0] : null;
    }

    /** @param {"component" | "material"} by */
    async split(by) {
        const piece = this.single();
        if (piece !== null) this.selectParts(piece, await this.edits.send({ type: "split", piece, by }));
    }

    /** Begins to paint faces of the selected piece; if painting already, splits the painted faces off. */
    async paint() {
        const { painting } = this.state;
        if (!painting) {
            const piece = this.single();
            if (piece !== null) this.state.set({ painting: { piece, faces: new Set() } });
            return;
        }
        if (painting.faces.size === 0) return toast("No face is painted.", "Drag over the faces that are to become a piece of their own, or press Escape.");
        const change = await this.edits.send({ type: "split", piece: painting.piece, by: { faces: [...painting.faces] } });
        if (!change) return;
        this.endPainting();
        this.selectParts(painting.piece, change);
    }

    /** @param {number} piece @param {any} change */
    selectParts(piece, change) {
        if (change) this.state.select([piece, ...change.added.map((/** @type {any} */ one) => one.piece)]);
    }

    endPainting() {
        this.state.set({ painting: null });
        this.stage.setPaintedFaces(new Set());
    }

    cancel() {
        if (this.state.painting) this.endPainting();
        else this.state.select([]);
    }

    /** Goes to the next unlabelled piece, most pixels first. @param {number} by */
    async step(by) {
        const { semantic } = this.state.pieces;
        const [selected] = this.state.selection;
        const place = this.unlabelled.findIndex((one) => one.piece === selected);
        const { length } = this.unlabelled;
        for (let i = 1; i <= length; i++) {
            const one = this.unlabelled[(((place < 0 && by < 0 ? 0 : place) + by * i) % length + length) % length];
            if (semantic[one.piece] < 1) return this.goToPiece(one.piece, one.best_view);
        }
        toast("Every piece has a class.", "", "good");
    }

    /** Selects a piece and looks at it. @param {number} piece @param {{ camera: string, frame: number } | null} [view] */
    goToPiece(piece, view = null) {
        this.state.select([piece]);
        const frame = view && this.frames.find((/** @type {any} */ one) => one.camera === view.camera && one.frame === view.frame);
        if (frame) this.goToFrame(this.frames.indexOf(frame));
        else this.frameSelection();
    }

    frameSelection() {
        const pieces = this.chosen();
        if (!pieces) return;
        const { mins, maxs } = this.state.pieces;
        /** @param {number[][]} corners @param {(...values: number[]) => number} pick */
        const extreme = (corners, pick) => [0, 1, 2].map((axis) => pieces.reduce((best, piece) => pick(best, corners[piece][axis]), corners[pieces[0]][axis]));
        this.stage.frameBox(extreme(mins, Math.min), extreme(maxs, Math.max));
    }

    /** @param {number} index */
    goToFrame(index) {
        const frame = this.frames[index];
        if (!frame) return;
        this.camera = index;
        byId("cameras").value = String(index);
        history.replaceState(null, "", `#camera=${encodeURIComponent(frame.camera)}:${frame.frame}`);
        this.stage.goTo(frame);
    }

    /** @param {number} by */
    stepCamera(by) {
        if (this.frames.length > 0) this.goToFrame((this.camera + by + this.frames.length) % this.frames.length);
    }

    xray() {
        const { state } = this;
        const pieces = this.chosen();
        if (!pieces) return;
        const all = pieces.every((piece) => state.xray.has(piece));
        const xray = new Set(state.xray);
        for (const piece of pieces) all ? xray.delete(piece) : xray.add(piece);
        state.setVisibility(state.hidden, xray, state.isolated);
    }

    isolate() {
        const { state } = this;
        if (state.isolated) return state.setVisibility([], state.xray);
        const pieces = this.chosen();
        if (pieces) state.setVisibility([...Array(state.count).keys()].filter((piece) => !state.selection.has(piece)), state.xray, true);
    }

    hide() {
        const { state } = this;
        const pieces = this.chosen();
        if (pieces) state.setVisibility([...state.hidden, ...pieces], state.xray, state.isolated);
        state.select([]);
    }

    toggleWireframe() {
        this.wireframe = !this.wireframe;
        this.stage.setWireframe(this.wireframe);
        this.state.tell("view");
    }

    toggleOutlines() {
        this.outlines = !this.outlines;
        this.stage.setOutlines(this.outlines);
        this.state.tell("view");
    }

    /** @param {number} factor */
    speed(factor) {
        const { controls } = this.stage;
        controls.speed = Math.min(20, Math.max(0.1, controls.speed * factor));
        this.state.tell("view");
    }

    toggleTheme() {
        const root = document.documentElement;
        const dark = root.dataset.theme ? root.dataset.theme === "dark" : !matchMedia("(prefers-color-scheme: light)").matches;
        root.dataset.theme = dark ? "light" : "dark";
        localStorage.setItem("enfilade.theme", root.dataset.theme);
        this.state.tell("theme");
    }

    async save() {
        try {
            const { files } = await postJson("/api/annotate/save", {});
            toast(`${files.length} files are written.`, this.state.scene.labels_folder, "good");
        } catch (error) {
            toastError(error);
        }
    }

    /** @param {string} tab */
    focusSearch(tab) {
        this.showTab(tab);
        /** @type {HTMLElement | null} */ (document.querySelector(`#panel-${tab} input[type="search"]`))?.focus();
    }

    /** Asks the server for the progress. */
    async progress() {
        const progress = await getJson("/api/annotate/progress");
        this.unlabelled = progress.unlabelled;
        this.state.dispatchEvent(new CustomEvent("progress", { detail: progress }));
    }
}
