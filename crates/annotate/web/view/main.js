// The page that shows a dataset: makes its parts, connects them, and lists all keys.

import { byId, el } from "../shared/dom.js";
import { fileUrl, getDataset, getFrame } from "./catalogue.js";
import { displayPanel } from "./display.js";
import { listenToKeys, showHelp } from "./keys.js";
import { GROUPS } from "./kinds.js";
import { showLegend } from "./legend.js";
import { showNotice } from "./notice.js";
import { objectsPanel } from "./objects.js";
import { showReadout } from "./readout.js";
import { framePanel, viewsPanel } from "./records.js";
import { Session } from "./session.js";
import { Space } from "./space.js";
import { Stage } from "./stage.js";
import { Store } from "./state.js";
import { Strip } from "./strip.js";
import { Travel } from "./travel.js";
import { Tree } from "./tree.js";

/** @typedef {import("./state.js").State} State */

const store = new Store();

async function begin() {
    const session = new Session(await getDataset(), store);
    const stage = new Stage(byId("stage"), store, session);
    const strip = new Strip(session);
    const tree = new Tree(session);
    const travel = new Travel(session);
    const page = new Page(session, stage, strip, tree, travel);
    await session.follow();
    page.ready();
    // For tests and the console.
    Object.assign(window, { view: page });
}

class Page {
    /**
     * @param {Session} session
     * @param {Stage} stage
     * @param {Strip} strip
     * @param {Tree} tree
     * @param {Travel} travel
     */
    constructor(session, stage, strip, tree, travel) {
        this.session = session;
        this.stage = stage;
        this.strip = strip;
        this.travel = travel;
        this.tree = tree;
        this.space = new Space(session);
        /** @type {import("./catalogue.js").FrameFacts | null} */
        this.known = null;
        this.panelKey = "";
        session.changed = () => stage.refresh();
        session.entered = () => {
            stage.last = [];
            this.known = null;
            tree.enter();
            strip.enter();
            this.controls();
            this.space.show();
        };
        stage.hovered = (pixel) => {
            session.hover(pixel);
            this.readout();
        };
        stage.painted = () => this.painted();
        store.listen((state, changed) => this.follow(state, changed));
        this.#listen();
        this.#verdict();
    }

    /** Says that the first picture is shown. */
    ready() {
        document.body.dataset.ready = "true";
        byId("stage").focus({ preventScroll: true });
    }

    /** @param {State} state @param {Set<keyof State>} changed */
    follow(state, changed) {
        if (changed.has("scene") || changed.has("camera")) {
            if (state.scene !== this.session.scene?.name || state.camera !== this.session.camera?.name) this.session.follow();
        }
        if (["frame", "layer", "other", "otherFrame", "mode"].some((key) => changed.has(/** @type {keyof State} */ (key)))) {
            this.session.refresh();
            this.controls();
        }
        if (["scene", "camera", "frame"].some((key) => changed.has(/** @type {keyof State} */ (key)))) this.known = null;
        if (changed.has("frame")) this.strip.show();
        if (["frame", "mode", "instance"].some((key) => changed.has(/** @type {keyof State} */ (key)))) this.space.show();
        this.panelKey = "";
        this.stage.refresh();
    }

    /** Updates everything that describes what is shown; called after each painting. */
    painted() {
        const { session } = this;
        const sides = session.sides();
        for (const i of [0, 1]) showLegend(/** @type {HTMLElement} */ (byId(`heading-${i}`).querySelector(".legend")), session, sides[i]);
        const failure = session.problem ?? sides.map((side) => session.failureOf(side.frame, side.layer)).find((one) => one);
        const message = byId("message");
        message.hidden = !failure;
        if (failure) message.textContent = `${/** @type {any} */ (failure).error ?? /** @type {any} */ (failure).message}\n${failure.help}`;
        byId("busy").hidden = session.complete && !this.travel.direction;
        byId("busy").textContent = this.travel.direction && this.travel.shown > 3 ? `${this.travel.rate.toFixed(0)} frames/s` : session.complete ? "" : "reading …";
        this.readout();
        this.panel();
    }

    readout() {
        showReadout(byId("readout"), this.session, this.stage.pixel);
    }

    /** Updates the panel on the right, unless nothing has changed or somebody is typing in it. */
    panel() {
        const { session } = this;
        const { state } = store;
        const panel = byId("panel");
        if (this.travel.direction && this.travel.held) return;
        const key = JSON.stringify([state.tab, state.scene, state.camera, state.frame, state.layer, state.other, state.otherFrame, state.mode, state.tone, state.expose, state.stops, state.ranges, state.maps, state.boxes, state.instance,
            session.sides().map((side) => side.data?.step), !!session.idsOf(state.frame), !!session.layer(state.frame, "semantic"), !!this.known]);
        if (key === this.panelKey) return;
        const typing = panel.contains(document.activeElement) && document.activeElement?.matches("input");
        if (typing && this.panelTab === state.tab && this.panelFrame === state.frame) return;
        this.panelKey = key;
        this.panelTab = state.tab;
        this.panelFrame = state.frame;
        if (state.tab !== "display" && state.tab !== "views") this.#learn();
        const focused = /** @type {HTMLElement | null} */ (panel.contains(document.activeElement) ? document.activeElement : null)?.dataset.instance;
        /** @type {Record<string, () => Node[]>} */
        const panels = {
            display: () => displayPanel(session),
            objects: () => objectsPanel(session, this.known, () => this.stage.refresh()),
            frame: () => framePanel(session, this.known),
            views: () => viewsPanel(session),
        };
        const { scrollTop } = panel;
        panel.replaceChildren(...panels[state.tab]());
        panel.scrollTop = scrollTop;
        if (focused) /** @type {HTMLElement | null} */ (panel.querySelector(`[data-instance="${focused}"]`))?.focus();
    }

    /** Asks the server about the frame. */
    async #learn() {
        const { scene, camera, frame } = store.state;
        if (this.known || !camera || this.learning === `${scene}/${camera}/${frame}`) return;
        this.learning = `${scene}/${camera}/${frame}`;
        try {
            const known = await getFrame(scene, camera, frame);
            if (store.state.frame === frame && store.state.scene === scene && store.state.camera === camera) this.known = known;
        } catch (error) {
            showNotice(/** @type {Error} */ (error).message);
        }
        this.learning = "";
        this.stage.refresh();
    }

    /** The controls above the picture, as the state has them. */
    controls() {
        const { session } = this;
        const { state } = store;
        byId("dataset-name").textContent = session.dataset.name;
        document.title = `${session.dataset.name}: ${state.scene} ${state.camera} ${state.frame}`;
        byId("place").textContent = `${state.scene} / ${state.camera}`;
        for (const button of byId("modes").children) button.setAttribute("aria-pressed", String(button.dataset.mode === state.mode));
        for (const tab of byId("tabs").children) tab.setAttribute("aria-selected", String(tab.dataset.tab === state.tab));
        byId("heading-1").hidden = state.mode !== "side" && state.mode !== "wipe";
        const there = session.layersOf(state.frame);
        this.#layers(byId("layer-0"), there, state.layer);
        this.#layers(byId("layer-1"), session.layersOf(state.otherFrame ?? state.frame), state.other);
        if (document.activeElement !== byId("frame-1")) byId("frame-1").value = state.otherFrame ?? "";
    }

    /** @param {HTMLSelectElement} select @param {string[]} there @param {string} chosen */
    #layers(select, there, chosen) {
        const key = `${there}`;
        if (select.dataset.key !== key) {
            select.dataset.key = key;
            const options = (/** @type {string[]} */ passes) => there.filter((name) => passes.includes(this.session.looks.spec(name).pass)).map((name) => el("option", { value: name }, name));
            select.replaceChildren(...GROUPS.map(({ name, passes }) => el("optgroup", { label: name }, ...options(passes))).filter((group) => group.children.length));
        }
        select.value = chosen;
    }

    #listen() {
        const { stage, travel } = this;
        byId("layer-0").addEventListener("change", (/** @type {any} */ e) => store.set({ layer: e.target.value }));
        byId("layer-1").addEventListener("change", (/** @type {any} */ e) => store.set({ other: e.target.value }));
        byId("frame-1").addEventListener("change", (/** @type {any} */ e) => store.set({ otherFrame: e.target.value === "" ? null : Math.round(e.target.valueAsNumber) }));
        for (const button of byId("modes").children) button.addEventListener("click", () => store.set({ mode: button.dataset.mode }));
        for (const tab of byId("tabs").children) tab.addEventListener("click", () => this.#tab(tab.dataset.tab));
        const groups = this.#keys();
        listenToKeys(groups);
        byId("help-button").addEventListener("click", () => showHelp(groups));
        byId("copy-link").addEventListener("click", () => this.#copyLink());
        byId("reload").addEventListener("click", () => this.#reload());
        byId("theme").addEventListener("click", () => this.#theme());
        byId("play").addEventListener("click", () => (travel.direction ? travel.stop() : travel.go(1, true)));
        document.documentElement.dataset.theme = localStorage.getItem("theme") ?? "";
        matchMedia("(prefers-color-scheme: light)").addEventListener("change", () => stage.refresh());
    }

    /** @param {string} tab */
    #tab(tab) {
        store.set({ tab });
        this.controls();
        byId("panel").scrollTop = 0;
    }

    async #copyLink() {
        const link = store.write();
        try {
            await navigator.clipboard.writeText(link);
            showNotice("The link to this view is on the clipboard.");
        } catch {
            showNotice("The address of this page is the link to this view.");
        }
    }

    async #reload() {
        try {
            await this.session.reload();
            showNotice("Read again.");
        } catch (error) {
            showNotice(/** @type {Error} */ (error).message);
        }
    }

    #theme() {
        const dark = getComputedStyle(document.documentElement).colorScheme === "dark";
        document.documentElement.dataset.theme = dark ? "light" : "dark";
        localStorage.setItem("theme", dark ? "light" : "dark");
        this.space.theme();
        this.stage.refresh();
    }

    #verdict() {
        const { verify, pages } = this.session.dataset;
        const card = pages.find((page) => page.title === "Report card");
        if (!verify) return byId("verdict").replaceChildren();
        const kind = !verify.passed ? "bad" : verify.accepted ? "good" : "warn";
        const text = verify.passed ? `${verify.laws} laws hold` : `${verify.failures.length} laws fail`;
        const title = [verify.verdict, verify.gate_verdict, ...verify.failures.map((law) => `${law.statement}: ${law.place}`)].join("\n");
        byId("verdict").replaceChildren(el("a", { class: `badge ${kind}`, href: card ? fileUrl(card.path) : undefined, target: "_blank", title }, text));
    }

    /** @returns {import("./keys.js").Group[]} */
    #keys() {
        const { session, stage, travel, tree } = this;
        const travelling = (/** @type {number} */ direction) => (/** @type {KeyboardEvent} */ event) => (event.repeat ? travel.hold() : travel.go(direction));
        const layer = (/** @type {number} */ step, /** @type {"layer" | "other"} */ which) => {
            const options = [.../** @type {HTMLSelectElement} */ (byId(which === "layer" ? "layer-0" : "layer-1")).options].map((option) => option.value);
            const at = options.indexOf(store.state[which]);
            store.set({ [which]: options[(at + step + options.length) % options.length] });
        };
        const show = (/** @type {string} */ name) => session.layersOf(store.state.frame).includes(name) && store.set({ layer: name });
        const mode = (/** @type {import("./state.js").Mode} */ name) => store.set({ mode: name });
        const frames = () => session.frames();
        return [
            { title: "Frames", keys: [
                { keys: ["ArrowLeft"], shown: "←", says: "frame before; hold to run", does: travelling(-1) },
                { keys: ["ArrowRight"], shown: "→", says: "next frame; hold to run", does: travelling(1) },
                { keys: ["PageUp"], shown: "Page up", says: "ten frames back", does: () => session.step(-10) },
                { keys: ["PageDown"], shown: "Page down", says: "ten frames on", does: () => session.step(10) },
                { keys: ["Home"], says: "first frame", does: () => store.set({ frame: frames()[0] }) },
                { keys: ["End"], says: "last frame", does: () => store.set({ frame: frames().at(-1) }) },
                { keys: [" "], shown: "Space", says: "play and stop", repeats: false, does: () => (travel.direction ? travel.stop() : travel.go(1, true)) },
                { keys: ["["], says: "camera before", does: () => tree.camera(-1) },
                { keys: ["]"], says: "next camera or scene", does: () => tree.camera(1) },
                { keys: ["/"], says: "find a scene", does: () => byId("scene-search").focus() },
            ] },
            { title: "Layers", keys: [
                { keys: ["ArrowUp"], shown: "↑", says: "layer before", does: () => layer(-1, "layer") },
                { keys: ["ArrowDown"], shown: "↓", says: "next layer", does: () => layer(1, "layer") },
                { keys: ["Shift+ArrowUp", "Shift+ArrowDown"], shown: "Shift+↑  Shift+↓", says: "layer of the other picture", does: (event) => layer(event.key === "ArrowUp" ? -1 : 1, "other") },
                { keys: ["C"], says: "color", does: () => show("color") },
                { keys: ["D"], says: "depth", does: () => show("depth_meters") },
                { keys: ["N"], says: "normals", does: () => show("normal_cam") },
                { keys: ["S"], says: "semantic classes", does: () => show("semantic") },
                { keys: ["I"], says: "instances", does: () => show("semantic_instance") },
                { keys: ["X"], says: "exchange the two pictures", does: () => store.set({ layer: store.state.other, other: store.state.layer }) },
            ] },
            { title: "Comparing", keys: [
                { keys: ["1"], says: "one picture", does: () => mode("one") },
                { keys: ["2"], says: "side by side", does: () => mode("side") },
                { keys: ["3"], says: "wipe", does: () => mode("wipe") },
                { keys: ["4"], says: "the scene in 3D", does: () => mode("space") },
                { keys: [",", "."], says: "move the border of the wipe", does: (event) => store.set({ wipe: Math.min(1, Math.max(0, store.state.wipe + (event.key === "," ? -0.02 : 0.02))) }) },
                { keys: ["K"], says: "keep this frame as the other; again: let go", does: () => store.set({ otherFrame: store.state.otherFrame === null ? store.state.frame : null }) },
            ] },
            { title: "Looking closely", keys: [
                { keys: ["+", "="], shown: "+", says: "closer", does: () => stage.zoomBy(1.5) },
                { keys: ["-"], says: "farther", does: () => stage.zoomBy(1 / 1.5) },
                { keys: ["0", "F"], says: "the whole picture", does: () => store.set({ zoom: 0, x: 0.5, y: 0.5 }) },
                { keys: ["Z"], says: "a pixel for a pixel", does: () => store.set({ zoom: 1 / stage.ratio }) },
                { keys: ["Shift+ArrowLeft", "Shift+ArrowRight"], shown: "Shift+←  Shift+→", says: "move sideways", does: (event) => stage.panBy(event.key === "ArrowLeft" ? 60 : -60, 0) },
                { keys: ["Alt+ArrowUp", "Alt+ArrowDown"], shown: "Alt+↑  Alt+↓", says: "move up and down", does: (event) => stage.panBy(0, event.key === "ArrowUp" ? 60 : -60) },
                { keys: ["V"], says: "in 3D: through this frame's camera", does: () => this.space.toFrame() },
                { keys: ["G"], says: "in 3D: from above, without ceilings", does: () => this.space.fromAbove() },
                { keys: ["B"], says: "boxes of all instances", does: () => store.set({ boxes: !store.state.boxes }) },
                { keys: ["Escape"], shown: "Esc", says: "let go of the instance", does: () => store.set({ instance: 0 }) },
            ] },
            { title: "Light", keys: [
                { keys: ["E"], says: "half a stop brighter", does: () => store.set({ stops: store.state.stops + 0.5 }) },
                { keys: ["Shift+E"], says: "half a stop darker", does: () => store.set({ stops: store.state.stops - 0.5 }) },
                { keys: ["Q"], says: "exposure as at the beginning", does: () => store.set({ stops: 0, expose: "frame", tone: "hypersim" }) },
                { keys: ["M"], says: "next curve", does: () => store.set({ tone: { hypersim: /** @type {const} */ ("filmic"), filmic: /** @type {const} */ ("linear"), linear: /** @type {const} */ ("hypersim") }[store.state.tone] }) },
            ] },
            { title: "Page", keys: [
                { keys: ["F1", "?"], shown: "?", says: "this list", does: () => showHelp(this.#keys()) },
                { keys: ["Alt+1", "Alt+2", "Alt+3", "Alt+4"], shown: "Alt+1  …  Alt+4", says: "Display, Objects, Frame, Views", does: (event) => this.#tab(["display", "objects", "frame", "views"][Number(event.key) - 1]) },
                { keys: ["T"], says: "dark or light", does: () => this.#theme() },
                { keys: ["Ctrl+Shift+L"], says: "copy the link to this view", does: () => this.#copyLink() },
                { keys: ["Shift+R"], says: "read the dataset again", does: () => this.#reload() },
            ] },
        ];
    }
}

begin().catch((error) => {
    byId("message").hidden = false;
    byId("message").textContent = `${error.message}\n${error.help ?? ""}`;
});
