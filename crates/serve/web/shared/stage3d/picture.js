// What is seen at each pixel (a target of integers), and the picture that is made from it.

import {
    AlwaysDepth, BufferAttribute, BufferGeometry, Color, DepthTexture, GLSL3, Matrix4, Mesh, NearestFilter, OrthographicCamera, RGIntegerFormat,
    RawShaderMaterial, Scene, UnsignedIntType, Vector2, WebGLRenderTarget,
} from "../../vendor/three.js";
import { pictureFragment, pictureVertex } from "./shaders.js";

/** Stands for no piece. */
export const NONE = 0xffffffff;

/** A target that holds piece, shade and face of each pixel, with depth. */
export class SeenTarget {
    /** @param {number} samples samples along one side of a pixel */
    constructor(samples) {
        this.samples = samples;
        /** @type {WebGLRenderTarget | null} */
        this.target = null;
        /** True when it shows all faces for the camera of now. */
        this.complete = false;
    }

    /**
     * The target for a picture of this size, made anew when the size has changed.
     *
     * @param {number} width pixels of the picture
     * @param {number} height
     */
    sized(width, height) {
        const [w, h] = [width * this.samples, height * this.samples];
        if (this.target && (this.target.width !== w || this.target.height !== h)) this.dispose();
        this.target ??= new WebGLRenderTarget(w, h, {
            format: RGIntegerFormat,
            type: UnsignedIntType,
            internalFormat: "RG32UI",
            minFilter: NearestFilter,
            magFilter: NearestFilter,
            generateMipmaps: false,
            depthTexture: new DepthTexture(w, h, UnsignedIntType),
        });
        return this.target;
    }

    dispose() {
        this.target?.depthTexture?.dispose();
        this.target?.dispose();
        this.target = null;
        this.complete = false;
    }
}

/** Draws the picture of a {@link SeenTarget}: colours, highlights, outlines. Writes depth, so that the scene hides what is drawn later. */
export class Picture {
    /** @param {import("./tables.js").Tables} tables */
    constructor(tables) {
        this.tables = tables;
        this.camera = new OrthographicCamera();
        this.uniforms = {
            seen: { value: /** @type {any} */ (null) },
            depth: { value: /** @type {any} */ (null) },
            pieceColors: { value: tables.colorTexture },
            pieceMarks: { value: tables.markTexture },
            faceMarks: { value: tables.noFaces },
            hasFaceMarks: { value: false },
            real: { value: false },
            faceColors: { value: tables.noColors },
            hasFaceColors: { value: false },
            photograph: { value: /** @type {any} */ (tables.noColors) },
            photographDepth: { value: /** @type {any} */ (null) },
            hasPhotograph: { value: false },
            worldFromClip: { value: new Matrix4() },
            photographFromWorld: { value: new Matrix4() },
            photographNearFar: { value: new Vector2() },
            outlines: { value: false },
            anyMarked: { value: false },
            samples: { value: 1 },
            scale: { value: 1 },
            hovered: { value: NONE },
            background: { value: new Color(0.1, 0.1, 0.1) },
            accent: { value: new Color(0.4, 0.65, 1) },
            paint: { value: new Color(1, 0.6, 0.2) },
        };
        const triangle = new BufferGeometry();
        triangle.setAttribute("position", new BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
        const material = new RawShaderMaterial({
            glslVersion: GLSL3,
            vertexShader: pictureVertex,
            fragmentShader: pictureFragment,
            uniforms: this.uniforms,
            depthFunc: AlwaysDepth,
        });
        this.mesh = new Mesh(triangle, material);
        this.mesh.frustumCulled = false;
        this.scene = new Scene().add(this.mesh);
    }

    /**
     * Draws it where the renderer draws now.
     *
     * @param {import("../../vendor/three.js").WebGLRenderer} renderer
     * @param {SeenTarget} seen
     * @param {import("../../vendor/three.js").PerspectiveCamera} camera that saw it
     * @param {import("./photograph.js").Photograph} photograph
     */
    draw(renderer, seen, camera, photograph) {
        const { uniforms, tables } = this;
        uniforms.seen.value = seen.target?.texture;
        uniforms.depth.value = seen.target?.depthTexture;
        uniforms.samples.value = seen.samples;
        uniforms.pieceColors.value = tables.colorTexture;
        uniforms.pieceMarks.value = tables.markTexture;
        uniforms.faceMarks.value = tables.faceMarks ?? tables.noFaces;
        uniforms.hasFaceMarks.value = tables.faceMarks !== null;
        uniforms.faceColors.value = tables.faceColors ?? tables.noColors;
        uniforms.hasFaceColors.value = tables.faceColors !== null;
        uniforms.worldFromClip.value.multiplyMatrices(camera.matrixWorld, camera.projectionMatrixInverse);
        uniforms.hasPhotograph.value = photograph.texture !== null;
        uniforms.photograph.value = photograph.texture ?? tables.noColors;
        uniforms.photographDepth.value = photograph.seen.target?.depthTexture ?? seen.target?.depthTexture;
        uniforms.photographFromWorld.value.copy(photograph.fromWorld);
        uniforms.photographNearFar.value.set(photograph.camera.near, photograph.camera.far);
        uniforms.scale.value = renderer.getPixelRatio();
        renderer.render(this.scene, this.camera);
    }

    dispose() {
        this.mesh.geometry.dispose();
        this.mesh.material.dispose();
    }
}
