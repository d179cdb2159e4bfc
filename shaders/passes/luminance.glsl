// Relative luminance of linear Rec. 709 / sRGB primaries (ITU-R BT.709).
float luminance(vec3 colour) { return dot(colour, vec3(0.2126, 0.7152, 0.0722)); }
