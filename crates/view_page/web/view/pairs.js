// The panel "Pairs": the frames that show the surfaces of this one, those with the largest overlap first; a click compares with one.

import { el } from "../shared/dom.js";
import { getPairs, thumbnailUrl } from "./catalogue.js";
import { percent } from "./numbers.js";
import { lossNote } from "./records.js";
import { TWO } from "./session.js";

/** @typedef {import("./catalogue.js").Pairs} Pairs */
/** @typedef {import("./catalogue.js").Partner} Partner */

export class PairsPanel {
    /** @param {import("./session.js").Session} session @param {() => void} changed */
    constructor(session, changed) {
        this.session = session;
        this.changed = changed;
        /** The frame that is known or asked about. */
        this.place = "";
        /** @type {Pairs | null} */
        this.known = null;
        /** @type {{ message: string, help: string } | null} */
        this.problem = null;
    }

    /** What the panel shows depends on this. */
    get key() {
        return `${this.place} ${!!this.known} ${!!this.problem}`;
    }

    /** @returns {Node[]} */
    show() {
        const { scene, camera, store } = this.session;
        if (!scene || !camera) return [];
        if (!scene.has_pairs) return [el("p", { class: "quiet" }, "Nobody has counted which frames of this scene see the same surfaces. `enfilade make OUT pairs` does it, without rendering.")];
        this.#learn(scene.name, camera.name, store.state.frame);
        if (this.problem) return [el("p", {}, this.problem.message), el("p", { class: "quiet" }, this.problem.help)];
        if (!this.known) return [el("p", { class: "quiet" }, "Reading …")];
        const { partners, count, hidden_by, problems } = this.known;
        const said = `${count === 1 ? "1 frame sees" : `${count} frames see`} surfaces of this one${count > partners.length ? `; here are the ${partners.length} with the largest overlap` : ""}. ${hidden_by === "scene" ? "A ray through the scene" : "The frames' distances alone"} decided what hides what.`;
        return [
            ...problems.map(lossNote),
            el("h2", {}, `Overlap with frame ${store.state.frame}`),
            el("p", { class: "quiet" }, count ? said : "No other frame of the scene sees a surface of this one."),
            el("div", { class: "views" }, ...partners.map((partner) => this.#card(scene.name, camera.name, partner))),
        ];
    }

    /** @param {string} scene @param {string} camera @param {number} frame */
    async #learn(scene, camera, frame) {
        const place = `${scene}/${camera}/${frame}`;
        if (this.place === place) return;
        [this.place, this.known, this.problem] = [place, null, null];
        try {
            const known = await getPairs(scene, camera, frame);
            if (this.place === place) this.known = known;
        } catch (error) {
            const { message, help } = /** @type {any} */ (error);
            if (this.place === place) this.problem = { message, help: help ?? "" };
        }
        this.changed();
    }

    /** @param {string} scene @param {string} here the camera that is open @param {Partner} partner */
    #card(scene, here, partner) {
        const { store } = this.session;
        const { camera, frame, this_seen, that_seen, baseline_m, angle_deg, listed } = partner;
        const otherCamera = camera === here ? "" : camera;
        const open = () => store.set({ mode: TWO.includes(store.state.mode) ? store.state.mode : "side", other: store.state.layer, otherFrame: frame, otherCamera });
        const share = (/** @type {number | null} */ value) => (value === null ? "–" : percent(value));
        const shown = TWO.includes(store.state.mode) && store.state.otherFrame === frame && store.state.otherCamera === otherCamera;
        return el("button", { type: "button", class: "view", "data-partner": `${camera}/${frame}`, "data-key": `partner-${camera}-${frame}`, "aria-pressed": String(shown), title: "Compare with this frame", onclick: open },
            el("img", { src: thumbnailUrl(scene, camera, frame), alt: "", loading: "lazy" }),
            el("span", {},
                el("b", {}, otherCamera ? `${camera}, frame ${frame}` : `Frame ${frame}`),
                el("br"), `sees ${share(this_seen)} of this`,
                el("br"), `this sees ${share(that_seen)} of it`,
                el("br"), el("span", { class: "quiet" }, baseline_m === null || angle_deg === null ? "no pose" : `${baseline_m.toFixed(2)} m apart, turned ${angle_deg.toFixed(0)}°`),
                ...(listed === false ? [el("br"), el("span", { class: "quiet" }, "not in pairs.csv")] : [])));
    }
}
