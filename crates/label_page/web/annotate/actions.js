// What the commands of the annotation page do with labels and the selection.

import { getJson, postJson } from "../shared/api.js";
import { say } from "../shared/say.js";
import { toggleTheme } from "../shared/theme.js";
import { toast, toastError } from "../shared/toast.js";
import { Digits } from "./digits.js";
import { Looking } from "./looking.js";
import { RealLook } from "./real_look.js";
import { stem } from "./names.js";
import { newInstance } from "./state.js";
import { Things } from "./things.js";

/** What the camera shows is told when it has rested for this long, milliseconds. */
const REST_MS = 600;

/** @typedef {{ piece: number, best_view: { camera: string, frame: number } | null, pixels: number, name: string }} Missing */

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
        this.digits = new Digits(state);
        this.things = new Things(this);
        this.looking = new Looking(state, stage);
        /** Faces that splits moved since the page was loaded, with their pieces. @type {[number[], number[]][]} */
        this.moved = [];
        this.realLook = new RealLook(state, stage, this.looking);
        /** Edits with the current label that the server has not answered yet. @type {Set<any>} */
        this.giving = new Set();
        /** Pieces that were sent with a label, or with how far they are, and not yet answered: they are done. @type {Set<number>} */
        this.sent = new Set();
        /** What lacks a class, and what has a class but lacks an instance; most pixels first. @type {Record<import("./state.js").Layer, Missing[]>} */
        this.missing = { semantic: [], instance: [] };
        /** What is to be done: what lacks a label, or what has this state of review. @type {import("./state.js").Layer | "done" | "question"} */
        this.lacking = "semantic";
        this.openHelp = () => {};
        this.openPalette = () => {};
        this.openSettings = () => {};
        this.openQuestion = (/** @type {string} */ _about) => {};
        this.showTab = (/** @type {string} */ _name) => {};
        this.telling = 0;
        /** Gives up the stroke that is being drawn; false if there is none. */
        this.giveUpStroke = () => false;
        // This runs before the next edit of the queue is sent, which may have to use the same new instance number.
        edits.addEventListener("change", (event) => {
            const answered = [...this.giving].find((edit) => !edits.queue.some(({ action }) => action === edit));
            if (answered) this.given(answered, /** @type {CustomEvent} */ (event).detail);
        });
    }

    /** Sends an edit that gives the current label. Resolves with the change; null if there is none. @param {any} action the edit without `apply` */
    async give(action) {
        const { apply } = this.state;
        if (!apply) return this.tellNoClass();
        const edit = { ...action, apply };
        this.giving.add(edit);
        const change = await this.edits.send(edit);
        this.given(edit, change);
        const { layer, value } = apply;
        if (change?.pieces.length > 0 && layer === "semantic" && value !== undefined && value >= 1) {
            this.state.remember(value);
            this.things.last = change.pieces;
        }
        return change;
    }

    /** Says that there is no class to give. @returns {null} */
    tellNoClass() {
        const { refused } = this.state;
        toast(refused === null ? "No class is chosen." : `No class has the number ${refused}, so nothing was labelled.`, "Type another number, or click a class.");
        return null;
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
        if (!pieces) return;
        if (!this.state.apply) return this.tellNoClass();
        await this.ahead(pieces, this.give({ type: "assign", pieces }), this.state.goesOn);
    }

    /**
     * Goes on from pieces before the server has answered, so that the next keys act on what is seen when they are pressed.
     *
     * @template T
     * @param {number[]} pieces
     * @param {Promise<T>} answer
     * @param {boolean} goesOn
     */
    async ahead(pieces, answer, goesOn) {
        for (const piece of pieces) this.sent.add(piece);
        if (goesOn) this.goOn(pieces);
        try {
            return await answer;
        } finally {
            for (const piece of pieces) this.sent.delete(piece);
        }
    }

    /** Makes the selection one thing: the current class and a new instance in one step. Goes on to the next unlabelled piece. */
    async makeThing() {
        const { currentClass, layer } = this.state;
        const pieces = this.chosen();
        if (!pieces) return;
        if (currentClass === null) return this.tellNoClass();
        this.things.last = pieces;
        const sent = this.edits.send({ type: "assign", pieces, apply: { layer: "semantic", value: currentClass, new: true } });
        const change = await this.ahead(pieces, sent, true);
        if (!change) return;
        this.state.remember(currentClass);
        this.state.set({ fresh: null, currentInstance: change.instance[0] ?? this.state.currentInstance });
        // The class that is given does not show in the layer of instances.
        if (layer === "instance") toast(`${this.state.classById.get(currentClass)?.name}: a new thing.`, "Ctrl+Z takes it back.", "good");
    }

    /** Goes on from these pieces, unless something else is selected. @param {number[]} pieces */
    goOn(pieces) {
        if (pieces.length === this.state.selection.size && pieces.every((piece) => this.state.selection.has(piece))) this.step(1);
    }

    async clearLabel() {
        const pieces = this.chosen();
        if (pieces) await this.edits.send({ type: "assign", pieces, apply: { layer: this.state.layer, value: -1 } });
    }

    /** Confirms suggestions, in one step. @param {number[]} pieces */
    async confirm(pieces) {
        const known = pieces.filter((piece) => this.state.suggestion(piece));
        if (known.length === 0) return toast("There is no suggestion for these pieces.", "Choose a class and press Enter.");
        const semantic = known.map((piece) => this.state.suggestion(piece)?.semantic);
        await this.ahead(known, this.edits.send({ type: "assign_each", pieces: known, semantic }), this.state.goesOn);
    }

    confirmSelection() {
        const pieces = this.chosen();
        if (pieces) void this.confirm(pieces);
    }

    /** Says how far the selection is. @param {import("./state.js").ReviewState} state @param {string} [note] */
    async review(state, note = "") {
        const pieces = this.chosen();
        if (!pieces) return;
        try {
            const sent = postJson("/api/annotate/review", { client: this.edits.client, who: this.edits.who, pieces, state, note });
            this.state.takeReviews(await this.ahead(pieces, sent, this.state.goesOn));
        } catch (error) {
            toastError(error);
        }
    }

    newInstance() {
        this.state.set({ layer: "instance", fresh: newInstance(), erase: false });
    }

    /** A class that was chosen by name: the selection gets it, unless a tool draws, and what is labelled next. @param {number} id */
    chooseClass(id) {
        this.state.setClass(id);
        const { selection, painting, drawMode } = this.state;
        if (selection.size > 0 && !painting && !drawMode) void this.assign();
    }

    /** Chooses a tool, which then draws by a plain drag; the eyedropper for one use. @param {import("./state.js").Tool} tool */
    chooseTool(tool) {
        const { state } = this;
        if (tool === "eyedropper" && state.tool !== "eyedropper") state.afterEyedropper = { tool: state.tool, drawMode: state.drawMode };
        state.set({ tool, drawMode: true });
    }

    /** Switches between drawing by a plain drag, and selecting and moving the camera. */
    toggleDrawing() {
        const { state } = this;
        if (state.tool === "eyedropper") state.set({ ...state.afterEyedropper, drawMode: false });
        else state.set({ drawMode: !state.drawMode });
    }

    /** Switches erasing: of labels, or while faces are painted, of the paint. */
    toggleErase() {
        const { painting, erase } = this.state;
        if (!painting) return this.state.set({ erase: !erase });
        this.state.set({ painting: { ...painting, erase: !painting.erase } });
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

    /** Splits the selected piece; all that it was split into is selected. @param {"component" | "material"} by */
    async split(by) {
        const piece = this.single();
        if (piece !== null) this.selectAdded(await this.edits.send({ type: "split", piece, by }), [piece]);
    }

    /** Begins to paint faces of the selected piece; if painting already, splits the painted faces off. */
    async paint() {
        const { painting } = this.state;
        if (!painting) {
            const piece = this.single();
            if (piece !== null) this.state.set({ painting: { piece, faces: new Set(), erase: false } });
            return;
        }
        if (painting.faces.size === 0) return toast("No face is painted.", "Drag over the faces that will become a new piece, or press Escape.");
        const change = await this.edits.send({ type: "split", piece: painting.piece, by: { faces: [...painting.faces] } });
        if (!change) return;
        this.endPainting();
        this.selectAdded(change);
    }

    /** Selects what a split has added, beside others. @param {any} change @param {number[]} [others] */
    selectAdded(change, others = []) {
        if (change) this.state.select([...others, ...change.added.map((/** @type {any} */ one) => one.piece)]);
    }

    endPainting() {
        this.state.set({ painting: null });
        this.stage.setPaintedFaces(new Set());
    }

    /** Steps back: from the stroke, from painting, from drawing, from the selection. */
    cancel() {
        if (this.giveUpStroke()) return;
        if (this.state.painting) this.endPainting();
        else if (this.state.drawMode) this.toggleDrawing();
        else this.state.select([]);
    }

    /** What is to be done, most pixels first. */
    get unlabelled() {
        if (this.lacking === "semantic" || this.lacking === "instance") return this.missing[this.lacking];
        const { reviews } = this.state;
        return [...reviews.keys()].filter((piece) => this.isMissing(piece)).map((piece) => ({ piece, best_view: null, pixels: 0, name: this.state.name(piece) }));
    }

    /** True when a piece is still to be done. @param {number} piece */
    isMissing(piece) {
        const { semantic, instance } = this.state.pieces;
        if (this.sent.has(piece)) return false;
        if (this.lacking === "semantic") return semantic[piece] < 1;
        if (this.lacking === "instance") return semantic[piece] >= 1 && instance[piece] < 1;
        return this.state.reviews.get(piece)?.state === this.lacking;
    }

    /** Goes to the next piece that is to be done. @param {number} by */
    step(by) {
        const [selected] = this.state.selection;
        const place = this.unlabelled.findIndex((one) => one.piece === selected);
        const { length } = this.unlabelled;
        for (let i = 1; i <= length; i++) {
            const one = this.unlabelled[(((place < 0 && by < 0 ? 0 : place) + by * i) % length + length) % length];
            if (!this.isMissing(one.piece)) continue;
            const left = this.unlabelled.filter(({ piece }) => this.isMissing(piece));
            say(`${this.state.name(one.piece)}, ${this.state.className(one.piece) || "no class"}, ${left.indexOf(one) + 1} of ${left.length} to do`);
            return this.looking.goToPiece(one.piece, one.best_view);
        }
        const all = { semantic: "Every piece has a class.", instance: "Everything with a class has an instance.", done: "Nothing is waiting for approval.", question: "No question is open." };
        toast(all[this.lacking], "", "good");
    }

    /** Says what is in the middle of the view, once the camera has come to rest. */
    tellView() {
        clearTimeout(this.telling);
        this.telling = setTimeout(() => {
            const { clientWidth, clientHeight } = this.stage.element;
            const { piece } = this.stage.seenAt(clientWidth / 2, clientHeight / 2);
            say(piece < 0 ? "Nothing in the middle" : `In the middle: ${this.state.name(piece)}, ${this.state.className(piece) || "no class"}`);
        }, REST_MS);
    }

    /** Does something with the selection, if there is one. @param {(pieces: number[]) => unknown} act */
    withSelection(act) {
        const pieces = this.chosen();
        if (pieces) void act(pieces);
    }

    toggleTheme() {
        toggleTheme();
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
        this.missing = { semantic: progress.unlabelled, instance: progress.without_instance };
        this.state.takeReviews(progress.reviews);
        this.state.dispatchEvent(new CustomEvent("progress", { detail: progress }));
    }
}
