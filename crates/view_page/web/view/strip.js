// The strip of frames below the picture. Only visible frames have elements, so trajectories may be long.

import { byId, el } from "../shared/dom.js";
import { thumbnailUrl } from "./catalogue.js";
import { faultText } from "./records.js";

export class Strip {
    /** @param {import("./session.js").Session} session */
    constructor(session) {
        this.session = session;
        this.element = byId("thumbnails");
        this.rail = el("div", { class: "rail" });
        this.element.replaceChildren(this.rail);
        /** @type {Map<number, HTMLElement>} */
        this.there = new Map();
        this.element.addEventListener("scroll", () => this.fill());
        new ResizeObserver(() => this.fill()).observe(this.element);
    }

    /** Width of a place, CSS pixels. */
    get pitch() {
        return 6 * parseFloat(getComputedStyle(this.element).fontSize);
    }

    /** Another trajectory. */
    enter() {
        const { camera, scene } = this.session;
        const key = `${scene?.name}/${camera?.name}`;
        this.key = key;
        this.there.clear();
        this.rail.replaceChildren();
        this.rail.style.width = `${(camera?.frames.length ?? 0) * this.pitch}px`;
        this.show();
    }

    fill() {
        const frames = this.session.camera?.frames ?? [];
        const { pitch } = this;
        const first = Math.max(0, Math.floor(this.element.scrollLeft / pitch) - 2);
        const last = Math.min(frames.length, Math.ceil((this.element.scrollLeft + this.element.clientWidth) / pitch) + 2);
        for (const [i, element] of this.there) {
            if (i >= first && i < last) continue;
            element.remove();
            this.there.delete(i);
        }
        for (let i = first; i < last; i++) {
            if (this.there.has(i)) continue;
            const { frame, layers, faults } = frames[i];
            const state = `${faults.some((fault) => fault.rejects) ? "rejected" : ""} ${layers.length ? "" : "planned"}`;
            const why = faults.length ? `: ${faults.map(faultText).join("; ")}` : layers.length ? "" : ": not rendered";
            const button = el("button", { type: "button", class: `thumb ${state}`, role: "option", id: `thumb-${frame}`, tabIndex: -1, title: `Frame ${frame}${why}`, "aria-label": `Frame ${frame}${why}`, "data-frame": frame, style: `left:${i * pitch}px`,
                onclick: () => (layers.length ? this.session.store.set({ frame }) : this.session.store.set({ tab: "views" })) },
                layers.length ? el("img", { src: thumbnailUrl(this.session.scene?.name ?? "", this.session.camera?.name ?? "", frame), alt: "", loading: "lazy", draggable: false }) : null, el("span", {}, String(frame)));
            this.there.set(i, button);
            this.rail.append(button);
        }
        this.#select();
    }

    /** Brings the frame that is shown into sight. */
    show() {
        const frames = this.session.camera?.frames ?? [];
        const at = frames.findIndex((one) => one.frame === this.session.store.state.frame);
        const { pitch } = this;
        const { scrollLeft, clientWidth } = this.element;
        if (at >= 0 && (at * pitch < scrollLeft || (at + 1) * pitch > scrollLeft + clientWidth)) this.element.scrollLeft = (at + 0.5) * pitch - clientWidth / 2;
        this.fill();
        const shown = this.session.frames();
        if (!shown.length) return byId("frame-number").replaceChildren();
        byId("frame-number").replaceChildren(`frame ${this.session.store.state.frame}`, el("br"), el("span", { class: "quiet" }, `${shown.indexOf(this.session.store.state.frame) + 1} of ${shown.length}`));
    }

    #select() {
        const { frame } = this.session.store.state;
        for (const element of this.there.values()) element.setAttribute("aria-selected", String(Number(element.dataset.frame) === frame));
        if ([...this.there.values()].some((element) => Number(element.dataset.frame) === frame)) this.element.setAttribute("aria-activedescendant", `thumb-${frame}`);
        else this.element.removeAttribute("aria-activedescendant");
    }
}
