// The page as a whole: what follows when the state changes, what is told after each painting, and the controls above the picture.

import { byId, el } from "../shared/dom.js";
import { oneTabStop } from "../shared/one_tab_stop.js";
import { resizable } from "../shared/resizable.js";
import { takeChosenTheme, toggleTheme } from "../shared/theme.js";
import { toast, toastError } from "../shared/toast.js";
import { fileUrl, getFrame } from "./catalogue.js";
import { commandsOf } from "./commands.js";
import { displayPanel } from "./display.js";
import { filterPanel } from "./filters.js";
import { Gallery } from "./gallery.js";
import { listenToKeys, showHelp } from "./keys.js";
import { GROUPS } from "./kinds.js";
import { layerSearch } from "./layer_search.js";
import { showDifferenceLegend, showLegend } from "./legend.js";
import { showMessage } from "./message.js";
import { objectsPanel } from "./objects.js";
import { PairsPanel } from "./pairs.js";
import { showReadout } from "./readout.js";
import { framePanel, lossesOf, viewsPanel } from "./records.js";
import { rulerWords } from "./ruler.js";
import { savePicture } from "./save.js";
import { TWO } from "./session.js";
import { Stage } from "./stage.js";
import { Strip } from "./strip.js";
import { Tools } from "./tools.js";
import { Travel } from "./travel.js";
import { Tree } from "./tree.js";
import { Watch } from "./watch.js";

/** @typedef {import("./state.js").State} State */

export class Page {
    /** @param {import("./session.js").Session} session @param {import("./state.js").Store} store */
    constructor(session, store) {
        this.session = session;
        this.store = store;
        this.stage = new Stage(byId("stage"), store, session);
        this.strip = new Strip(session);
        this.tree = new Tree(session);
        this.travel = new Travel(session);
        this.pairs = new PairsPanel(session, () => this.panel());
        this.gallery = new Gallery(session, () => this.panel());
        this.findLayer = layerSearch(session);
        this.tools = new Tools(session, this.stage);
        /** Scene, camera and frame of what was measured; empty while an address is followed. */
        this.place = "";
        /** The scene in 3D, once it was asked for. @type {import("./space.js").Space | null} */
        this.space = null;
        /** @type {import("./catalogue.js").FrameFacts | null} */
        this.known = null;
        this.panelKey = "";
        /** What the panel shows: its tab, and the frame. */
        this.panelTab = "";
        this.panelFrame = -1;
        /** The frame that the server is asked about. */
        this.learning = "";
        session.changed = () => this.stage.refresh();
        session.entered = () => this.#entered();
        this.stage.hovered = (pixel) => {
            session.hover(pixel);
            this.readout();
        };
        this.stage.painted = () => this.painted();
        this.watch = new Watch(session, (frames) => this.#grown(frames));
        store.listen((state, changed) => this.follow(state, changed));
        this.#listen();
        this.#verdict();
        this.gallery.show();
        this.modes();
    }

    /** Says that the first picture is shown. */
    ready() {
        document.body.dataset.ready = "true";
        this.gallery.isShown ? this.gallery.focus() : byId("stage").focus({ preventScroll: true });
    }

    /** Another scene or camera is open. */
    #entered() {
        this.stage.last = [];
        this.known = null;
        this.panelKey = "";
        this.tree.enter();
        this.strip.enter();
        if (this.store.state.mode === "difference") this.#beginDifference();
        this.controls();
        this.#space();
    }

    /** Shows the scene in 3D when the state asks for it; what draws it is fetched then. */
    async #space() {
        if (!this.space && this.store.state.mode !== "space") return;
        if (!this.space) {
            const { Space } = await import("./space.js");
            this.space ??= new Space(this.session);
        }
        await this.space.show();
    }

    /** The dataset has changed while one looked. @param {number} frames how many are new */
    async #grown(frames) {
        if (frames > 0) toast(frames === 1 ? "1 new frame." : `${frames} new frames.`, "", "good");
        this.#verdict();
        await this.gallery.reload();
    }

    /** @param {State} state @param {Set<keyof State>} changed */
    follow(state, changed) {
        const has = (/** @type {(keyof State)[]} */ ...keys) => keys.some((key) => changed.has(key));
        if (has("scene", "camera") && (state.scene !== this.session.scene?.name || state.camera !== this.session.camera?.name)) this.session.follow();
        if (has("otherCamera")) this.#followOther();
        if (has("layer", "other", "otherFrame", "otherCamera", "mode")) this.#keepApart(changed);
        if (has("mode")) this.modes();
        if (has("frame", "layer", "other", "otherFrame", "otherCamera", "mode", "flicker")) {
            this.session.refresh();
            this.controls();
        }
        if (has("scene", "camera", "frame")) this.known = null;
        this.#keepRuler(state, has("ruler", "span"));
        if (has("ruler")) this.session.refresh();
        if (has("frame", "track")) this.tools.followTrack();
        if (has("frame", "layer", "mode", "camera")) this.tools.tell();
        if (has("frame")) this.strip.show();
        if (has("frame", "mode", "instance")) this.#space();
        if (has("view")) this.space?.look();
        if (has("span")) this.space?.ruler();
        if (has("mode", "sort", "down", "within", "show", "gate", "law", "shows", "limits", "scene", "camera")) this.gallery.show();
        this.panelKey = "";
        this.stage.refresh();
    }

    /** What was measured is of one frame, or in 3D of one scene, and ends with it. @param {State} state @param {boolean} isNew */
    #keepRuler({ scene, camera, frame, ruler, span }, isNew) {
        if (isNew) this.place = "";
        if (!scene || !camera) return;
        const place = `${scene}/${camera}/${frame}`;
        if (span && this.place !== "" && !this.place.startsWith(`${scene}/`)) this.store.set({ span: "" }, { step: false });
        const isOther = this.place !== "" && this.place !== place;
        this.place = place;
        if (ruler && isOther) this.store.set({ ruler: "" }, { step: false });
    }

    /** Another camera gives the other picture. */
    async #followOther() {
        await this.session.followOther();
        this.session.refresh();
        this.controls();
    }

    /** Two pictures of one frame have different layers: the one that was not chosen gives way. @param {Set<keyof State>} changed */
    #keepApart(changed) {
        const { mode, layer, other, frame } = this.store.state;
        if (mode === "difference" && changed.has("mode")) return this.#beginDifference();
        if (!TWO.includes(mode) || layer !== other || this.session.isOtherFrame) return;
        const free = this.session.layersOf(frame).filter((name) => name !== layer);
        const instead = free.find((name) => name === (layer === "color" ? "depth_meters" : "color")) ?? free[0];
        if (instead) this.store.set(changed.has("layer") || !changed.has("other") ? { other: instead } : { layer: instead }, { step: false });
    }

    /** A difference begins with two layers that can be compared; where the frame has no two, with two frames. */
    #beginDifference() {
        const { layer, other, otherFrame, frame } = this.store.state;
        const alike = this.session.othersOf(true);
        const isOther = this.session.isOtherFrame;
        if (alike.includes(other) && (other !== layer || isOther)) return;
        const instead = alike.find((name) => name.startsWith(layer) && name !== layer);
        const frames = this.session.frames();
        const beside = frames[frames.indexOf(frame) + 1] ?? frames[frames.indexOf(frame) - 1] ?? null;
        if (instead && !isOther) this.store.set({ other: instead }, { step: false });
        else this.store.set({ other: layer, otherFrame: isOther ? otherFrame : beside }, { step: false });
    }

    /** What belongs to the mode is shown, and nothing else. */
    modes() {
        const { mode } = this.store.state;
        document.body.dataset.mode = mode;
        for (const id of ["headings", "stage", "readout", "strip", "tabs"]) byId(id).hidden = mode === "gallery" || (mode === "space" && ["headings", "readout"].includes(id));
        byId("gallery").hidden = mode !== "gallery";
        for (const button of byId("modes").children) button.setAttribute("aria-pressed", String(button.dataset.mode === mode));
    }

    /** Updates everything that describes what is shown; called after each painting. */
    painted() {
        const { session, travel } = this;
        const sides = session.sides();
        for (const i of [0, 1]) showLegend(/** @type {HTMLElement} */ (byId(`heading-${i}`).querySelector(".legend")), session, sides[i]);
        showDifferenceLegend(/** @type {HTMLElement} */ (byId("heading-2").querySelector(".legend")), session);
        this.#message(sides);
        byId("busy").hidden = session.complete && !travel.direction;
        byId("busy").textContent = travel.direction && travel.shown > 3 ? `${travel.rate.toFixed(0)} frames/s` : session.complete ? "" : "reading …";
        this.readout();
        this.panel();
    }

    /** Says what cannot be shown: of one of two pictures in its place, else over all. @param {import("./session.js").Side[]} sides */
    #message(sides) {
        const { session, stage, store } = this;
        const failures = sides.map((side) => session.failureOf(side) ?? null);
        const general = session.problem ?? session.noDifference;
        const failed = failures.findIndex((one) => one);
        const element = byId("message");
        const isOfOne = !general && sides.length > 1 && failed >= 0 && failures.filter((one) => one).length === 1 && store.state.mode !== "difference";
        const { x, y, width, height } = isOfOne ? stage.areaOf(failed) : { x: 0, y: 0, width: 0, height: 0 };
        const px = (/** @type {number} */ device) => (isOfOne ? `${device / stage.ratio}px` : "");
        Object.assign(element.style, { left: px(x + width / 2), top: px(y + height / 2), maxWidth: px(0.94 * width) });
        showMessage(element, general ?? failures[failed] ?? null);
    }

    readout() {
        showReadout(byId("readout"), this.session, this.stage.pixel);
    }

    /** Updates the panel on the right, unless nothing has changed or somebody is typing in it. */
    panel() {
        const { session, store } = this;
        const { state } = store;
        const panel = byId("panel");
        if (this.travel.direction && this.travel.held) return;
        const tab = state.mode === "gallery" ? "filter" : state.tab;
        const key = JSON.stringify([tab, state, session.sides().map((side) => side.data?.step), state.ruler && rulerWords(session), !!session.camera && state.tracks && !!session.tracks.of(session.camera), !!session.idsOf(state.frame), !!session.layer(state.frame, "semantic"), !!this.known, this.gallery.panelKey, this.pairs.key]);
        if (key === this.panelKey) return;
        const typing = panel.contains(document.activeElement) && document.activeElement?.matches("input");
        if (typing && this.panelTab === tab && this.panelFrame === state.frame) return;
        this.panelKey = key;
        this.panelTab = tab;
        this.panelFrame = state.frame;
        if (tab === "objects" || tab === "frame") this.#learn();
        const focused = /** @type {HTMLElement | null} */ (panel.contains(document.activeElement) ? document.activeElement : null)?.dataset.key;
        /** @type {Record<string, () => Node[]>} */
        const panels = {
            filter: () => filterPanel(this.gallery, store),
            display: () => displayPanel(session),
            objects: () => objectsPanel(session, this.known, () => this.stage.refresh()),
            frame: () => framePanel(session, this.known),
            views: () => viewsPanel(session),
            pairs: () => this.pairs.show(),
        };
        const { scrollTop } = panel;
        panel.replaceChildren(...lossesOf(session, this.known, tab), ...panels[tab]());
        panel.scrollTop = scrollTop;
        if (focused) /** @type {HTMLElement | null} */ (panel.querySelector(`[data-key="${focused}"]`))?.focus();
    }

    /** Asks the server about the frame. */
    async #learn() {
        const { scene, camera, frame } = this.store.state;
        const place = `${scene}/${camera}/${frame}`;
        if (this.known || !camera || this.learning === place) return;
        this.learning = place;
        try {
            const known = await getFrame(scene, camera, frame);
            const { state } = this.store;
            if (`${state.scene}/${state.camera}/${state.frame}` === place) this.known = known;
        } catch (error) {
            toastError(error);
        }
        this.learning = "";
        this.stage.refresh();
    }

    /** The controls above the picture, as the state has them. */
    controls() {
        const { session } = this;
        const { state } = this.store;
        byId("dataset-name").textContent = session.dataset.name;
        document.title = state.mode === "gallery" ? session.dataset.name : `${session.dataset.name}: ${state.scene} ${state.camera} ${state.frame}`;
        byId("place").textContent = state.mode === "gallery" ? "" : [state.scene, state.camera].filter(Boolean).join(" / ");
        for (const tab of byId("tabs").children) tab.setAttribute("aria-selected", String(tab.dataset.tab === state.tab));
        byId("heading-1").hidden = !TWO.includes(state.mode);
        byId("heading-2").hidden = state.mode !== "difference";
        byId("flicker").setAttribute("aria-pressed", String(state.flicker));
        this.#layers(byId("layer-0"), session.layersOf(state.frame), state.layer);
        const others = session.othersOf(state.mode === "difference");
        this.#layers(byId("layer-1"), others.filter((name) => session.isOtherFrame || name !== state.layer), state.other);
        byId("other-camera").textContent = state.otherCamera ? `${state.otherCamera} ` : "";
        if (document.activeElement !== byId("frame-1")) byId("frame-1").value = state.otherFrame ?? "";
    }

    /** @param {HTMLSelectElement} select @param {string[]} there @param {string} chosen */
    #layers(select, there, chosen) {
        const key = `${there}`;
        if (select.dataset.key !== key) {
            select.dataset.key = key;
            const options = (/** @type {string[]} */ passes) => there.filter((name) => passes.includes(this.session.looks.spec(name).pass)).map((name) => el("option", { value: name }, this.session.looks.title(name)));
            select.replaceChildren(...GROUPS.map(({ name, passes }) => el("optgroup", { label: name }, ...options(passes))).filter((group) => group.children.length));
        }
        select.value = chosen;
    }

    #listen() {
        const { stage, travel, store } = this;
        const choose = (/** @type {"layer" | "other"} */ which) => (/** @type {any} */ event) => {
            store.set({ [which]: event.target.value });
            // From here on the arrow keys go from frame to frame.
            byId("stage").focus({ preventScroll: true });
        };
        byId("layer-0").addEventListener("change", choose("layer"));
        byId("layer-1").addEventListener("change", choose("other"));
        byId("frame-1").addEventListener("change", (/** @type {any} */ e) => store.set(e.target.value === "" ? { otherFrame: null, otherCamera: "" } : { otherFrame: Math.round(e.target.valueAsNumber) }));
        for (const button of byId("modes").children) button.addEventListener("click", () => store.set({ mode: button.dataset.mode }));
        for (const tab of byId("tabs").children) tab.addEventListener("click", () => this.tab(tab.dataset.tab));
        resizable(byId("tree"), "right");
        resizable(byId("inspector"), "left");
        oneTabStop(byId("tabs"), { along: "row" });
        oneTabStop(byId("panel"), { entries: "tr[tabindex]", along: "column" });
        for (const [button, column] of [["tree-button", "tree"], ["panel-button", "inspector"]]) byId(button).addEventListener("click", () => this.#drawer(byId(button), byId(column)));
        const commands = commandsOf(this);
        listenToKeys(commands);
        byId("menu").addEventListener("click", () => byId("menu").hidePopover());
        byId("find-layer").addEventListener("click", () => this.findLayer());
        byId("help-button").addEventListener("click", () => showHelp(commands));
        byId("flicker").addEventListener("click", () => store.set({ flicker: !store.state.flicker }));
        byId("save").addEventListener("click", () => this.save());
        byId("copy-link").addEventListener("click", () => this.copyLink());
        byId("reload").addEventListener("click", () => this.reload());
        byId("theme").addEventListener("click", () => this.theme());
        byId("play").addEventListener("click", () => (travel.direction ? travel.stop() : travel.go(1, true)));
        takeChosenTheme();
        matchMedia("(prefers-color-scheme: light)").addEventListener("change", () => stage.refresh());
    }

    /** Opens or closes a column that narrow windows have no room for. @param {HTMLElement} button @param {HTMLElement} column */
    #drawer(button, column) {
        const open = column.dataset.open !== "true";
        column.dataset.open = String(open);
        button.setAttribute("aria-expanded", String(open));
    }

    /** @param {string} tab */
    tab(tab) {
        this.store.set({ tab });
        this.controls();
        byId("panel").scrollTop = 0;
    }

    /** Saves what is shown as a picture. */
    save() {
        const { state } = this.store;
        const name = [state.scene, state.camera, String(state.frame).padStart(4, "0"), state.mode === "space" ? "3d" : state.layer, state.mode === "one" || state.mode === "space" ? "" : state.other];
        if (state.mode === "gallery") return toast("Open a frame to save its picture.");
        savePicture(state.mode === "space" ? (this.space?.painting() ?? []) : this.stage.painting(), name.filter(Boolean).join("_"));
    }

    async copyLink() {
        const link = this.store.write();
        try {
            await navigator.clipboard.writeText(link);
            toast("The link to this view is on the clipboard.", "", "good");
        } catch {
            toast("The address of this page is the link to this view.", "", "good");
        }
    }

    async reload() {
        try {
            await this.session.reload();
            this.#verdict();
            await this.gallery.reload();
            toast("Read again.", "", "good");
        } catch (error) {
            toastError(error);
        }
    }

    theme() {
        toggleTheme();
        this.space?.theme();
        this.stage.refresh();
    }

    /** What verification said: a link to the report, and one to the frames that were rejected. */
    #verdict() {
        const { verify, verify_problem, pages } = this.session.dataset;
        const card = pages.find((page) => page.title === "Report card");
        const unread = { class: "badge bad", title: `verify.json cannot be read, so that neither checks nor rejected frames show: ${verify_problem}. Run enfilade verify again.` };
        if (!verify) return byId("verdict").replaceChildren(...(verify_problem ? [el("span", unread, "Report unreadable")] : []));
        const { failures, laws, passed, rejected } = verify;
        const text = passed ? "Checks pass" : failures.length === 1 ? "1 check fails" : `${failures.length} checks fail`;
        const title = [`${laws} checks. ${verify.verdict}`, verify.gate_verdict, ...failures.map((law) => `${law.statement}: ${law.place}`)].join("\n");
        const frames = el("button", { type: "button", class: "badge warn", title: "Show them in the gallery",
            onclick: () => this.store.set({ mode: "gallery", show: "rejected", within: "all", limits: {}, gate: "", law: "", shows: 0 }) }, rejected === 1 ? "1 frame rejected" : `${rejected} frames rejected`);
        byId("verdict").replaceChildren(el("a", { class: `badge ${passed ? "good" : "bad"}`, href: card ? fileUrl(card.path) : undefined, target: "_blank", title }, text), ...(rejected ? [frames] : []));
    }
}
