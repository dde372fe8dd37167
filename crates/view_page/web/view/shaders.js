// GPU programs that turn stored numbers into colours. `kind` is the index of the layer's kind in KINDS.

/** @type {import("./kinds.js").Kind[]} */
export const KINDS = ["radiance", "albedo", "scalar", "direction", "stretched", "flow", "texture", "id", "code", "display"];

export const VERTEX = `#version 300 es
void main() {
    vec2 corner = vec2(float((gl_VertexID << 1) & 2), float(gl_VertexID & 2));
    gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}`;

/**
 * The program for textures of a sampler: `sampler2D`, `isampler2D` or `usampler2D`.
 * @param {string} sampler
 */
export const fragment = (sampler) => `#version 300 es
precision highp float;
precision highp int;
precision highp ${sampler};
precision highp isampler2D;
uniform ${sampler} values;
uniform isampler2D ids;
uniform sampler2D table;
uniform int kind;
uniform vec2 size;        // of the picture, pixels
uniform float texel;      // pixels per texel of the values
uniform vec2 origin;      // of the picture's upper left corner, device pixels from the upper left of the canvas
uniform float zoom;       // device pixels per pixel
uniform float canvas_height;
uniform float exposure;
uniform int tone;         // 0 Hypersim's gamma, 1 filmic, 2 linear
uniform vec2 range;
uniform bool logarithm;   // the map goes by the logarithm between the ends of the range
uniform int marked;       // id that is marked; 0 none
uniform bool alone;       // what is not marked is darkened; otherwise the mark is an outline, and colours can be read
uniform vec3 accent;
out vec4 color;

vec3 gamma_curve(vec3 linear) {
    return pow(clamp(linear, 0.0, 1e9), vec3(1.0 / 2.2));
}

vec3 srgb(vec3 v) {
    v = clamp(v, 0.0, 1.0);
    return mix(12.92 * v, 1.055 * pow(v, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, v));
}

// Narkowicz 2015, "ACES filmic tone mapping curve".
vec3 filmic(vec3 v) {
    return srgb(clamp(v * (2.51 * v + 0.03) / (v * (2.43 * v + 0.59) + 0.14), 0.0, 1.0));
}

vec3 toned(vec3 radiance) {
    vec3 v = max(radiance, 0.0) * exposure;
    if (tone == 1) return filmic(v);
    if (tone == 2) return srgb(v);
    return min(gamma_curve(v), 1.0);
}

// Pixels without a number: a grey chequer, which no colour map has.
vec3 nothing(vec2 at) {
    return vec3(mod(floor(at.x / 8.0) + floor(at.y / 8.0), 2.0) < 0.5 ? 0.16 : 0.20);
}

vec3 mapped(float t) {
    return texelFetch(table, ivec2(int(clamp(t, 0.0, 1.0) * 255.0 + 0.5), 0), 0).rgb;
}

vec3 listed(int number) {
    int place = clamp(number + 1, 0, 65535);
    return texelFetch(table, ivec2(place & 255, place >> 8), 0).rgb;
}

vec3 hue(float h) {
    return clamp(abs(fract(h + vec3(0.0, 2.0, 1.0) / 3.0) * 6.0 - 3.0) - 1.0, 0.0, 1.0);
}

bool finite(float v) { return !(isnan(v) || isinf(v)); }

vec3 shown(vec4 v, vec2 at) {
    if (kind == 7 || kind == 8) return listed(int(v.r));
    if (kind == 9) return v.rgb / 255.0;
    if (kind == 0) return finite(v.r + v.g + v.b) ? toned(v.rgb) : nothing(at);
    if (kind == 1) return min(gamma_curve(v.rgb), 1.0);
    if (!finite(v.r)) return nothing(at);
    if (kind == 2 && logarithm) return v.r > 0.0 ? mapped(log(v.r / range.x) / log(range.y / range.x)) : nothing(at);
    if (kind == 2) return mapped((v.r - range.x) / (range.y - range.x));
    if (kind == 3) return 0.5 + 0.5 * v.rgb;
    if (kind == 4) return (v.rgb - range.x) / (range.y - range.x);
    if (kind == 5) return mix(vec3(1.0), hue(atan(v.g, v.r) / 6.28318530718), clamp(length(v.rg) / range.y, 0.0, 1.0));
    float tile = mod(floor(v.r * 8.0) + floor(v.g * 8.0), 2.0);
    return vec3(fract(v.rg), 0.25 + 0.25 * tile);
}

void main() {
    vec2 device = vec2(gl_FragCoord.x, canvas_height - gl_FragCoord.y);
    vec2 at = (device - origin) / zoom;
    if (at.x < 0.0 || at.y < 0.0 || at.x >= size.x || at.y >= size.y) discard;
    vec3 rgb = vec3(0.0);
    if (zoom < 0.75 && (kind < 2 || kind == 9) && texel == 1.0) {
        // Shown smaller than it is: the mean of the colours that fall on this pixel, which avoids aliasing.
        int n = min(int(ceil(1.0 / zoom)), 4);
        vec2 first = at - 0.5 / zoom;
        for (int y = 0; y < n; y++) for (int x = 0; x < n; x++) {
            vec2 p = clamp(first + (vec2(x, y) + 0.5) / (float(n) * zoom), vec2(0.0), size - 1.0);
            rgb += shown(vec4(texelFetch(values, ivec2(p), 0)), device);
        }
        rgb /= float(n * n);
    } else {
        rgb = shown(vec4(texelFetch(values, ivec2(at / texel), 0)), device);
    }
    if (marked > 0) {
        ivec2 p = ivec2(at);
        ivec2 last = ivec2(size) - 1;
        int reach = max(1, int(round(1.0 / zoom)));
        bool inside = texelFetch(ids, p, 0).r == marked;
        bool edge = false;
        for (int i = 0; i < 4; i++) {
            ivec2 q = clamp(p + reach * ivec2(i == 0 ? 1 : i == 1 ? -1 : 0, i == 2 ? 1 : i == 3 ? -1 : 0), ivec2(0), last);
            edge = edge || (texelFetch(ids, q, 0).r == marked) != inside;
        }
        // If pixels are large enough to read their colours, the mark does not change them.
        bool close = zoom >= 12.0;
        if (inside && edge) rgb = mix(rgb, accent, close ? 0.4 : 1.0);
        else if (!inside && alone) rgb *= close ? 0.85 : 0.62;
    }
    color = vec4(rgb, 1.0);
}`;
