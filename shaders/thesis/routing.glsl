// Stencil routing, per texel: order the layers of the pixel that the texel projects to and take the last one in front.
// Included by a shader that defines abuffer_layer() and abuffer_filled() for its kind of A-buffer.

layout(local_size_x = SIDE, local_size_y = SIDE) in;
layout(binding = 2, rgba32f) uniform readonly image2D position;
layout(binding = 3, rgba32f) uniform readonly image2D normal;
layout(binding = 4, rgba32f) uniform readonly image2D face_normal;
layout(binding = 5, rgba32f) uniform writeonly image2D psf_irradiance;  // rgb: w_k L_k [W m^-2]; a: w_k [sr]
layout(binding = 6, r32f) uniform image2D cover;  // weights [sr] of rays that start in contact, less all others
layout(binding = 7) readonly buffer WallsFirst { uint walls_first[]; };  // of each triangle in walls; one more at the end
layout(binding = 8) uniform samplerBuffer walls;                         // two ends each [m]
layout(binding = 9, rgba32ui) uniform readonly uimage2D near_walls;
layout(binding = 10) buffer Counted { Counters counters; };
layout(push_constant) uniform Push { RoutingConstants constants; };

#include "layer_order.glsl"
#include "receiver.glsl"

void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(position)))) return;
  const vec4 p = imageLoad(position, texel);
  const PsfView view = constants.view;
  const vec3 n = imageLoad(normal, texel).xyz;
  const vec4 face_and_triangle = imageLoad(face_normal, texel);
  const vec3 face = face_and_triangle.xyz;
  const float cosine = -dot(n, view.direction.xyz);
  const float face_cosine = -dot(face, view.direction.xyz);
  if (p.a == 0.0 || cosine <= 0.0 || face_cosine <= 0.0) {
    imageStore(psf_irradiance, texel, vec4(0.0));
    return;
  }
  // On the plane, face . (x - p) = 0; the view's rows have length 1 / radius, their directions are unit vectors.
  const vec3 right = normalize(view.right.xyz), up = normalize(view.up.xyz);
  const vec2 slope = vec2(dot(face, right), dot(face, up)) / face_cosine;
  const float depth = dot(view.along, p);
  const vec2 projected = vec2(dot(view.right, p), dot(view.up, p));

  const float size = float(constants.size), pixel_width = 2.0 / size;
  const vec2 in_pixels = (projected * 0.5 + 0.5) * size;
  const ivec2 nearest = ivec2(in_pixels);
  const vec2 within = in_pixels - vec2(nearest) - 0.5;  // of the nearest centre
  const float weight = cosine * view.direction.w;
  const float tolerance = receiver_tolerance(slope, pixel_width);
  const uvec4 near = imageLoad(near_walls, texel);
  const uint triangle = uint(face_and_triangle.a);
  const Blur blur = blur_of(pixel_width, length(view.along.xyz), view.direction.xyz, face_cosine);
  bool known = false, in_contact = false;
  vec3 radiance = vec3(0.0);
  bool missed = true;
  // Of the 2 x 2 pixels around the texel the nearest that tells what the texel sees: its centre meets the texel's own
  // surface, or, if there is none, at least does not lie behind a wall.
  for (uint choice = 0u; choice < 8u; ++choice) {
    const ivec2 pixel = clamp(nearest + beside_nearest(choice % 4u, within), ivec2(0), ivec2(size) - 1);
    const vec2 centre = (vec2(pixel) + 0.5) * pixel_width - 1.0;
    const float own_depth = receiver_depth(centre - projected, depth, slope);
    const vec3 away = (right * (centre.x - projected.x) + up * (centre.y - projected.y) +
                       view.direction.xyz * (own_depth - depth)) / length(view.along.xyz);
    if (wall_between(near, triangle, p.xyz, away, face, blur, choice >= 4u)) continue;
    known = true;
    const uint layer = last_in_front(pixel, constants.size, own_depth + tolerance);
    if (layer < LAYERS) {
      const vec4 seen = abuffer_layer(pixel, constants.size, layer);
      radiance = seen.rgb;
      in_contact = seen.a >= own_depth - tolerance - CONTACT * pixel_width / face_cosine;
      missed = false;
      break;
    }
    // Nothing is seen from there, and so from the texel, unless the centre looks past the receiver itself.
    if (chart_reaches(texel, p.xyz, away)) break;
  }
  imageStore(psf_irradiance, texel, known ? vec4(weight * radiance, weight) : vec4(0.0));
  if (constants.count != 0u) {
    atomicAdd(counters.rays, 1u);
    if (!known) atomicAdd(counters.unknown, 1u);
    else if (missed) atomicAdd(counters.misses, 1u);
    imageStore(cover, texel, imageLoad(cover, texel) + (in_contact ? weight : -weight));
  }
}
