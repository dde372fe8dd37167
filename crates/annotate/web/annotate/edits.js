// Edits on their way to the server. One at a time and in order; what is not acknowledged is kept and sent again, over reloads too.

import { ApiError, getJson, postJson } from "../shared/api.js";
import { toast, toastError } from "../shared/toast.js";

const RETRY_MS = 1500;
const STORE = "enfilade.annotate.unsent";

/** Sends edits and hears of those of other tabs. Events: `state` when something about saving has changed, `change` with a CHANGE. */
export class Edits extends EventTarget {
    /** @param {string} scene tells apart what is kept for several scenes */
    constructor(scene) {
        super();
        this.client = crypto.randomUUID?.() ?? `tab-${Math.random().toString(36).slice(2)}`;
        this.store = `${STORE}:${scene}`;
        /** @type {{ action: any, done: (change: any) => void, lost?: boolean, answer?: any }[]} */
        this.queue = [];
        this.offline = false;
        this.busy = false;
        for (const action of JSON.parse(sessionStorage.getItem(this.store) ?? "[]")) this.queue.push({ action, done: () => {} });
        if (this.queue.length > 0) toast(`${this.queue.length} edits had not reached the server; they are sent again.`, "", "good");
    }

    /** @returns {"saved" | "saving" | "offline"} */
    get state() {
        return this.offline ? "offline" : this.queue.length > 0 ? "saving" : "saved";
    }

    /**
     * Sends an edit. Resolves with the CHANGE, or null where it was refused, which the user has been told then.
     *
     * @param {any} action
     * @returns {Promise<any>}
     */
    send(action) {
        return new Promise((done) => {
            this.queue.push({ action, done });
            this.keep();
            void this.work();
        });
    }

    keep() {
        sessionStorage.setItem(this.store, JSON.stringify(this.queue.map((one) => one.action)));
        this.dispatchEvent(new Event("state"));
    }

    async work() {
        if (this.busy) return;
        this.busy = true;
        while (this.queue.length > 0) {
            const first = this.queue[0];
            const { action, done } = first;
            let change = first.answer ?? null;
            try {
                change ??= await postJson("/api/annotate/edit", { client: this.client, action });
                this.offline = false;
            } catch (error) {
                if (error instanceof ApiError && error.status === 0) {
                    first.lost = true;
                    this.setOffline(true);
                    // Long enough for the events to tell whether it had arrived after all.
                    await new Promise((resume) => setTimeout(resume, RETRY_MS));
                    continue;
                }
                toastError(error);
            }
            this.queue.shift();
            if (change) this.dispatchEvent(new CustomEvent("change", { detail: change }));
            this.keep();
            done(change);
        }
        this.busy = false;
    }

    /** @param {boolean} offline */
    setOffline(offline) {
        if (this.offline === offline) return;
        this.offline = offline;
        this.dispatchEvent(new Event("state"));
    }

    /**
     * Hears of changes from here on. After a break the server replays what was missed, or asks for a reload.
     *
     * @param {() => number} revision the last one that is known
     * @param {() => void} reload takes everything anew
     */
    listen(revision, reload) {
        const source = new EventSource(`/api/annotate/events?since=${revision()}`);
        source.addEventListener("message", (event) => {
            const change = JSON.parse(event.data);
            const first = this.queue[0];
            if (change.client === this.client && first?.lost) first.answer = change;
            this.dispatchEvent(new CustomEvent("change", { detail: change }));
        });
        source.addEventListener("reload", reload);
        source.addEventListener("open", () => this.setOffline(false));
        source.addEventListener("error", () => {
            this.setOffline(true);
            source.close();
            setTimeout(() => void this.resume(revision, reload), RETRY_MS);
        });
    }

    /** @param {() => number} revision @param {() => void} reload */
    async resume(revision, reload) {
        try {
            const scene = await getJson("/api/annotate/scene");
            if (scene.revision < revision()) reload();
        } catch {
            setTimeout(() => void this.resume(revision, reload), RETRY_MS);
            return;
        }
        this.listen(revision, reload);
    }
}
