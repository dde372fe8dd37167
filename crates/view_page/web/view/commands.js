// Every key of the page and what it does; the help is made of the same table.

import { byId } from "../shared/dom.js";
import { toast } from "../shared/toast.js";
import { showHelp } from "./keys.js";

/** @param {import("./page.js").Page} page @returns {import("./keys.js").Group[]} */
export function commandsOf(page) {
    const { session, stage, travel, tree, store } = page;
    const inGallery = () => store.state.mode === "gallery";
    const travelling = (/** @type {number} */ direction) => (/** @type {KeyboardEvent} */ event) => {
        if (inGallery()) page.gallery.key(event);
        else if (event.repeat) travel.hold();
        else travel.go(direction);
    };
    const layer = (/** @type {number} */ step, /** @type {"layer" | "other"} */ which) => {
        const options = [.../** @type {HTMLSelectElement} */ (byId(which === "layer" ? "layer-0" : "layer-1")).options].map((option) => option.value);
        const at = options.indexOf(store.state[which]);
        store.set({ [which]: options[(at + step + options.length) % options.length] });
    };
    const layerOrRow = (/** @type {number} */ step) => (/** @type {KeyboardEvent} */ event) => (inGallery() ? page.gallery.key(event) : layer(step, "layer"));
    const show = (/** @type {string} */ name) => session.layersOf(store.state.frame).includes(name) && store.set({ layer: name });
    const logarithm = () => {
        const { layer, logs } = store.state;
        const { [layer]: on, ...others } = logs;
        store.set({ logs: on ? others : { ...logs, [layer]: true } });
    };
    const mode = (/** @type {import("./state.js").Mode} */ name) => store.set({ mode: name });
    const far = (/** @type {number} */ steps) => (/** @type {KeyboardEvent} */ event) => (inGallery() ? page.gallery.key(event) : session.step(steps));
    const arrows = (/** @type {string} */ before) => ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"].map((key) => before + key);
    const read = (/** @type {number} */ step) => (/** @type {KeyboardEvent} */ { key }) => page.tools.readPixel(step * (Number(key === "ArrowRight") - Number(key === "ArrowLeft")), step * (Number(key === "ArrowDown") - Number(key === "ArrowUp")));
    return [
        { title: "Frames", keys: [
            { keys: ["ArrowLeft"], shown: "←", says: "frame before; hold to run", does: travelling(-1) },
            { keys: ["ArrowRight"], shown: "→", says: "next frame; hold to run", does: travelling(1) },
            { keys: ["PageUp"], shown: "Page up", says: "ten frames back", does: far(-10) },
            { keys: ["PageDown"], shown: "Page down", says: "ten frames on", does: far(10) },
            { keys: ["Home"], says: "first frame", does: far(-Infinity) },
            { keys: ["End"], says: "last frame", does: far(Infinity) },
            { keys: [" "], shown: "Space", says: "play and stop", repeats: false, does: () => (travel.direction ? travel.stop() : travel.go(1, true)) },
            { keys: ["["], says: "camera before", does: () => tree.camera(-1) },
            { keys: ["]"], says: "next camera or scene", does: () => tree.camera(1) },
            { keys: ["H"], says: "tag this frame, or not", does: () => page.gallery.mark("tagged") },
            { keys: ["R"], says: "drop this frame, or not", does: () => page.gallery.mark("dropped") },
            { keys: ["/"], says: "find a scene", does: () => byId("scene-search").focus() },
        ] },
        { title: "Layers", keys: [
            { keys: ["ArrowUp"], shown: "↑", says: "layer before", does: layerOrRow(-1) },
            { keys: ["ArrowDown"], shown: "↓", says: "next layer", does: layerOrRow(1) },
            { keys: ["Shift+ArrowUp", "Shift+ArrowDown"], shown: "Shift+↑  Shift+↓", says: "layer of the other picture", does: (event) => layer(event.key === "ArrowUp" ? -1 : 1, "other") },
            { keys: ["C"], says: "color", does: () => show("color") },
            { keys: ["D"], says: "depth", does: () => show("depth_meters") },
            { keys: ["N"], says: "normals", does: () => show("normal_cam") },
            { keys: ["S"], says: "semantic classes", does: () => show("semantic") },
            { keys: ["I"], says: "instances", does: () => show("semantic_instance") },
            { keys: ["Ctrl+K"], says: "find a layer by its name", does: () => (inGallery() ? toast("Layers are of one frame.", "Open a frame first, with Enter.") : page.findLayer()) },
            { keys: ["X"], says: "exchange the two pictures", does: () => store.set({ layer: store.state.other, other: store.state.layer }) },
        ] },
        { title: "Comparing", keys: [
            { keys: ["A"], says: "all frames: the gallery", does: () => mode("gallery") },
            { keys: ["1"], says: "one picture", does: () => mode("one") },
            { keys: ["2"], says: "side by side", does: () => mode("side") },
            { keys: ["3"], says: "wipe", does: () => mode("wipe") },
            { keys: ["4"], says: "the scene in 3D", does: () => mode("space") },
            { keys: ["5"], says: "difference of two pictures", does: () => mode("difference") },
            { keys: ["Y"], says: "flicker between the two", does: () => store.set({ mode: "difference", flicker: !(store.state.mode === "difference" && store.state.flicker) }) },
            { keys: [",", "."], says: "move the border of the wipe", does: (event) => store.set({ wipe: Math.min(1, Math.max(0, store.state.wipe + (event.key === "," ? -0.02 : 0.02))) }) },
            { keys: ["K"], says: "keep this frame as the other; again: let go", does: () => store.set({ otherFrame: store.state.otherFrame === null ? store.state.frame : null, otherCamera: "" }) },
        ] },
        { title: "Looking closely", keys: [
            { keys: ["+", "="], shown: "+", says: "closer", does: () => stage.zoomBy(1.5) },
            { keys: ["-"], says: "farther", does: () => stage.zoomBy(1 / 1.5) },
            { keys: ["0", "F"], says: "the whole picture", does: () => store.set({ zoom: 0, x: 0.5, y: 0.5 }) },
            { keys: ["Z"], says: "a pixel for a pixel", does: () => store.set({ zoom: 1 / stage.ratio }) },
            { keys: ["Shift+ArrowLeft", "Shift+ArrowRight"], shown: "Shift+←  Shift+→", says: "move sideways", does: (event) => stage.panBy(event.key === "ArrowLeft" ? 60 : -60, 0) },
            { keys: ["Alt+ArrowUp", "Alt+ArrowDown"], shown: "Alt+↑  Alt+↓", says: "move up and down", does: (event) => stage.panBy(0, event.key === "ArrowUp" ? 60 : -60) },
            { keys: ["V"], says: "in 3D: through this frame's camera", does: () => page.space?.toFrame() },
            { keys: ["G"], says: "in 3D: from above, without ceilings", does: () => page.space?.fromAbove() },
            { keys: ["B"], says: "boxes of all instances", does: () => store.set({ boxes: !store.state.boxes }) },
            { keys: ["Shift+B"], says: "names on boxes", does: () => store.set({ names: !store.state.names }) },
            { keys: ["P"], says: "points that are followed", does: () => store.set({ tracks: !store.state.tracks }) },
            { keys: ["Shift+P"], says: "the next of these points alone", does: () => page.tools.nextTrack() },
            { keys: ["L"], says: "logarithmic colours", does: logarithm },
            { keys: ["J"], says: "measure from here; again: to here", does: () => (store.state.mode === "space" ? page.space?.measure() : page.tools.measure()) },
            { keys: arrows("Ctrl+"), shown: "Ctrl+arrows", says: "read pixel by pixel", does: read(1) },
            { keys: arrows("Ctrl+Shift+"), shown: "Ctrl+Shift+arrows", says: "ten pixels at a time", does: read(10) },
            { keys: ["Escape"], shown: "Esc", says: "let go of the instance, point, distance", does: () => store.set({ instance: 0, class: 0, track: 0, ruler: "", span: "" }) },
        ] },
        { title: "Light", keys: [
            { keys: ["E"], says: "half a stop brighter", does: () => store.set({ stops: store.state.stops + 0.5 }) },
            { keys: ["Shift+E"], says: "half a stop darker", does: () => store.set({ stops: store.state.stops - 0.5 }) },
            { keys: ["Q"], says: "exposure as at the beginning", does: () => store.set({ stops: 0, expose: "frame", tone: "hypersim" }) },
            { keys: ["M"], says: "next curve", does: () => store.set({ tone: { hypersim: /** @type {const} */ ("filmic"), filmic: /** @type {const} */ ("linear"), linear: /** @type {const} */ ("hypersim") }[store.state.tone] }) },
        ] },
        { title: "Page", keys: [
            { keys: ["F1", "?"], shown: "?", says: "this list", does: () => showHelp(commandsOf(page)) },
            { keys: ["Alt+1", "Alt+2", "Alt+3", "Alt+4", "Alt+5"], shown: "Alt+1  …  Alt+5", says: "Display, Objects, Frame, Views, Pairs", does: (event) => page.tab(["display", "objects", "frame", "views", "pairs"][Number(event.key) - 1]) },
            { keys: ["T"], says: "dark or light", does: () => page.theme() },
            { keys: ["Ctrl+S"], says: "save what is shown as a picture", does: () => page.save() },
            { keys: ["Ctrl+Shift+L"], says: "copy the link to this view", does: () => page.copyLink() },
            { keys: ["Shift+R"], says: "read the dataset again", does: () => page.reload() },
        ] },
    ];
}
