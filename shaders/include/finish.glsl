// The end of a bounce, for every engine. Thesis, section 4.6, and the contract of docs/algorithm.md.

const float PI = 3.14159265358979;

// E [W m^-2] from sums over directions, rgb: of w_k L_k; a: of w_k [sr]: E = pi * S / W. Dividing by the weights that were
// met makes every row of the transport operator sum to one.
// `direct`: the irradiance that comes straight from lamps, for engines that know it apart and leave it out of the sums.
vec3 irradiance_of(vec4 sum, vec3 direct) { return sum.a > 0.0 ? direct + PI * sum.rgb / sum.a : direct; }

// L [W m^-2 sr^-1] that a diffuse surface sends: L = Le + albedo / pi * E.
vec3 radiance_of(vec3 emission, vec3 albedo, vec3 irradiance) { return emission + albedo / PI * irradiance; }
