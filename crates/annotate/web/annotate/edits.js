// The queue of edits for the server. They are sent one at a time and in order. Unacknowledged edits are kept and sent again, also after a
// reload. Each has an id, by which the server recognises an edit that it has done already.

import { ApiError, getJson, postJson } from "../shared/api.js";
import { toast, toastError } from "../shared/toast.js";

const RETRY_MS = 1500;
const STORE = "enfilade.annotate.unsent";

/** A unique id. Browsers have `randomUUID` only for https and for pages of this machine. */
const newId = () => crypto.randomUUID?.() ?? Array.from(crypto.getRandomValues(new Uint32Array(4)), (part) => part.toString(36)).join("-");

/** Sends edits and hears of those of other tabs. Events: `state` when something about saving has changed, `change` with a change. */
export class Edits extends EventTarget {
    /** @param {string} scene so that unsent edits of several scenes are kept apart */
    constructor(scene) {
        super();
        this.client = newId();
        this.store = `${STORE}:${scene}`;
        /** @type {{ id: string, action: any, done: (change: any) => void }[]} */
        this.queue = [];
        this.offline = false;
        this.busy = false;
        for (const kept of JSON.parse(sessionStorage.getItem(this.store) ?? "[]")) this.queue.push({ ...kept, done: () => {} });
        if (this.queue.length > 0) toast(`${this.queue.length} edits were not acknowledged by the server; they are sent again.`, "", "good");
    }

    /** @returns {"saved" | "saving" | "offline"} */
    get state() {
        return this.offline ? "offline" : this.queue.length > 0 ? "saving" : "saved";
    }

    /**
     * Sends an edit. Resolves with the change, or with null if it was refused, which the user is told.
     *
     * @param {any} action
     * @returns {Promise<any>}
     */
    send(action) {
        return new Promise((done) => {
            this.queue.push({ id: newId(), action, done });
            this.keep();
            void this.work();
        });
    }

    keep() {
        sessionStorage.setItem(this.store, JSON.stringify(this.queue.map(({ id, action }) => ({ id, action }))));
        this.dispatchEvent(new Event("state"));
    }

    async work() {
        if (this.busy) return;
        this.busy = true;
        while (this.queue.length > 0) {
            const { id, action, done } = this.queue[0];
            let change = null;
            try {
                change = await postJson("/api/annotate/edit", { client: this.client, id, action });
                this.offline = false;
            } catch (error) {
                if (error instanceof ApiError && error.status === 0) {
                    this.setOffline(true);
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
     * Listens to changes. After a lost connection the server repeats what was missed, or asks for a reload.
     *
     * @param {() => number} revision the last one that is known
     * @param {() => void} reload takes everything anew
     */
    listen(revision, reload) {
        const source = new EventSource(`/api/annotate/events?since=${revision()}`);
        source.addEventListener("message", (event) => {
            this.dispatchEvent(new CustomEvent("change", { detail: JSON.parse(event.data) }));
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
