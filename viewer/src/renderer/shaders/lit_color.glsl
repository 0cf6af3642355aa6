// Makes colors lighter or darker by a factor, as render/volume/lit_layer.h does. OKLab keeps the hue. Colors are sRGB
// from 0 to 1.

vec3 toLinear(vec3 c) {
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c));
}
vec3 toSrgb(vec3 c) {
    c = clamp(c, 0.0, 1.0);
    return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}

vec3 toLab(vec3 srgb) {
    vec3 c = toLinear(srgb);
    vec3 lms = pow(max(vec3(0.0), vec3(
        dot(c, vec3(0.4122214708, 0.5363325363, 0.0514459929)),
        dot(c, vec3(0.2119034982, 0.6806995451, 0.1073969566)),
        dot(c, vec3(0.0883024619, 0.2817188376, 0.6299787005)))), vec3(1.0 / 3.0));
    return vec3(dot(lms, vec3(0.2104542553, 0.7936177850, -0.0040720468)),
        dot(lms, vec3(1.9779984951, -2.4285922050, 0.4505937099)),
        dot(lms, vec3(0.0259040371, 0.7827717662, -0.8086757660)));
}

// Returns linear light, which may be outside of 0 to 1.
vec3 fromLab(vec3 lab) {
    vec3 lms = vec3(lab.x) + lab.y * vec3(0.3963377774, -0.1055613458, -0.0894841775)
        + lab.z * vec3(0.2158037573, -0.0638541728, -1.2914855480);
    lms = lms * lms * lms;
    return vec3(dot(lms, vec3(4.0767416621, -3.3077115913, 0.2309699292)),
        dot(lms, vec3(-1.2684380046, 2.6097574011, -0.3413193965)),
        dot(lms, vec3(-0.0041960863, -0.7034186147, 1.7076147010)));
}

float lightnessOf(vec3 srgb) {
    return toLab(srgb).x;
}

bool canBeShown(vec3 linear) {
    return !(any(lessThan(linear, vec3(-1e-4))) || any(greaterThan(linear, vec3(1.0001))));
}

vec3 litColor(vec3 srgb, float factor) {
    vec3 lab = toLab(srgb);
    float l = lab.x;
    // Below 1, darken to half of the lightness at most, and reduce chroma with it. Above 1, lighten toward white.
    if (factor < 1.0) {
        l *= max(0.5, 1.0 - 0.9 * (1.0 - factor));
        lab.yz *= lab.x > 0.0 ? sqrt(l / lab.x) : 1.0;
    } else {
        l += max(0.0, 0.98 - l) * (1.0 - exp(-1.44 * (factor - 1.0)));
    }
    lab.x = l;
    vec3 linear = fromLab(lab);
    // Search for the greatest chroma that can be shown. Clamping the channels instead would change the hue.
    if (!canBeShown(linear)) {
        float low = 0.0, high = 1.0;
        for (int i = 0; i < 7; ++i) {
            float middle = 0.5 * (low + high);
            if (canBeShown(fromLab(vec3(lab.x, middle * lab.yz)))) low = middle;
            else high = middle;
        }
        linear = fromLab(vec3(lab.x, low * lab.yz));
    }
    return toSrgb(linear);
}
