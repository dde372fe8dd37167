// The list of scenes and their cameras.

import { byId, el } from "../shared/dom.js";
import { oneTabStop } from "../shared/one_tab_stop.js";
import { fileUrl } from "./catalogue.js";

/** At most this many scenes are listed; others are found by searching. */
const MAX_SHOWN = 500;

export class Tree {
    /** @param {import("./session.js").Session} session */
    constructor(session) {
        this.session = session;
        oneTabStop(byId("scenes"), { along: "column" });
        byId("scene-search").addEventListener("input", () => this.enter());
        byId("scene-search").addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
            const [first] = this.#found();
            if (event.key === "Enter" && first) this.#open(first);
        });
    }

    #found() {
        const words = byId("scene-search").value.toLowerCase().split(/\s+/).filter(Boolean);
        return this.session.dataset.scenes.filter((name) => words.every((/** @type {string} */ word) => name.toLowerCase().includes(word)));
    }

    /** @param {string} scene @param {string} [camera] */
    #open(scene, camera = "") {
        const { store } = this.session;
        const within = store.state.mode !== "gallery" ? store.state.within : camera ? "camera" : "scene";
        store.set({ scene, camera, otherFrame: null, otherCamera: "", instance: 0, view: "", within });
    }

    enter() {
        const { scene, camera, dataset } = this.session;
        const found = this.#found();
        const item = (/** @type {string} */ name) => {
            const open = name === scene?.name;
            const cameras = open ? el("ul", {}, ...scene.cameras.map((one) => el("li", {}, el("button", { type: "button", class: "plain", "aria-current": String(one === camera?.name), onclick: () => this.#open(name, one) }, one)))) : null;
            return el("li", {}, el("button", { type: "button", class: "plain", "aria-current": String(open), title: name, onclick: () => this.#open(name) }, name), cameras);
        };
        byId("scenes").replaceChildren(...found.slice(0, MAX_SHOWN).map(item), ...(found.length > MAX_SHOWN ? [el("li", { class: "quiet" }, `and ${found.length - MAX_SHOWN} more`)] : []),
            ...(found.length ? [] : [el("li", { class: "quiet" }, dataset.scenes.length ? "No scene has such a name." : "No scenes yet.")]));
        byId("pages").replaceChildren(...[...dataset.pages, ...(scene?.pages ?? [])].map((page) => el("a", { href: fileUrl(page.path), target: "_blank" }, page.title)));
    }

    /** The next camera, or the first of the next scene. @param {number} step */
    async camera(step) {
        const { scene, camera, dataset } = this.session;
        if (!scene || !camera) return;
        const at = scene.cameras.indexOf(camera.name) + step;
        if (scene.cameras[at]) return this.#open(scene.name, scene.cameras[at]);
        const other = dataset.scenes[dataset.scenes.indexOf(scene.name) + step];
        if (other) this.#open(other);
    }
}
