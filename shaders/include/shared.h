// What C++ and GLSL both know: the constants of each pass. Rows and colours are vec4, so that both sides agree on the
// layout. Lengths are metres where not said otherwise; PSF space is the scene scaled into the unit sphere.
#ifndef LICHTVELD_SHARED_H
#define LICHTVELD_SHARED_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>
namespace lichtveld::shaders {
using glm::ivec4;
using glm::uvec4;
using glm::vec4;
using uint = std::uint32_t;
#define SHARED_FUNCTION inline
#else
#define SHARED_FUNCTION
#endif

// Invocations of a compute workgroup a side, over texels or pixels.
const uint SIDE = 8;

// Depth of an A-buffer slot that holds nothing. PSF depths lie in [-1, 1].
const float NO_LAYER = 4.0;

// Marks a texel that neither lies on a chart nor in a gutter.
const uint NO_TEXEL = 0xffffffffu;

// Gutter around the charts that is filled from their nearest texel [texels]: what bilinear filtering can reach.
const int GUTTER = 2;

// A surface so near above a receiver counts as lying or standing on it [pixels of a PSF]: a raster does not see between
// them. Wider gaps are gaps.
const float CONTACT = 0.125;

// Farther than any wall [m].
const float FAR = 1e30;

// Bins of the log-luminance histogram, over [2^LOG_LUMINANCE_MIN, 2^LOG_LUMINANCE_MAX): radiance from 1e-6 to 1e6 fits.
// Bin 0 holds what is darker, black included.
const uint HISTOGRAM_BINS = 1024;
const float LOG_LUMINANCE_MIN = -24.0;
const float LOG_LUMINANCE_MAX = 24.0;

// Middle grey of a presented map, the tone-mapping operator's usual key value.
const float KEY = 0.18;

// --sort
const uint SORT_BITONIC = 0;
const uint SORT_COMPARE_SWAP = 1;
const uint SORT_SCAN = 2;

// One direction's orthographic view. A point p [m] has the PSF coordinates dot(row.xyz, p) + row.w, each in [-1, 1]:
// right and up across the view, along = depth in the direction the light travels.
struct PsfView {
  vec4 right, up, along;
  vec4 direction;  // xyz: unit direction the light travels; w: its solid angle [sr]
};

struct GeometryConstants {
  vec4 offset;  // xyz: the body's shift from rest [m]
  uint first_triangle;
};

struct EmitConstants {
  PsfView view;
  uint size;      // of the PSF raster [pixels]
  uint capacity;  // layers that the A-buffer holds
  uint limit;     // layers asked for: pixels with more are counted
  uint count;     // 1: count layers
};

struct RoutingConstants {
  PsfView view;
  uint size;   // of the PSF raster [pixels]
  uint count;  // 1: count rays and misses, and what lies in contact
};

struct LayerConstants {
  uint size, layer;
};

// --method links. A pair is a direction and its antipode, which share one A-buffer.

// A group: consecutive records, a workgroup's.
const uint GROUP = 64;

// Texels whose words of a pair lie together in the table of links: 64 bytes, of which GROUP holds a whole number.
const uint LINE = 16;

// Parts of the directions, as many of either half, each of which spans the sphere: what a bounce may leave for the next.
const uint PARTS = 8;

// Of so many pairs, where a part begins: of whole words of the table, which hold two links.
SHARED_FUNCTION uint first_pair_of_part(uint pairs, uint part) { return pairs / 2 * part / PARTS * 2; }

// A valid texel as a receiver, where its body is.
struct Receiver {
  vec4 at;                 // xyz [m]; w: the atlas texel
  vec4 face_and_triangle;  // as LightMap::face_normal
  vec4 normal_and_wall;    // xyz: unit; w: as near.z, for whoever asks for no more of it [m]
  uvec4 near;              // as LightMap::near_walls
};

// A patch of a pair's raster, and where it lies in the store that many share. Its pixels lie together there, row by row.
struct Region {
  PsfView view;
  ivec4 rect;   // first column and row, columns, rows, of the pair's raster [pixels]
  ivec4 store;  // xy: first column and row as it is drawn [pixels]; z: the pair; w: first pixel in the store
};

// Tiles of texels that look into a region: a workgroup's work.
struct RouteJob {
  uint region;
  uint first, end;  // in the list of tiles
};

struct EmitLinksConstants {
  uint size;  // of a pair's raster [pixels]
  uint store_pixels;
  uint capacity;  // layers that a pixel has room for
  uint windows;   // regions that are drawn at once
};

struct CountLayersConstants {
  uint pixels;  // of the store that are in use
  uint limit;   // layers asked for: pixels with more are counted
};

struct RouteLinksConstants {
  uint size;         // of a pair's raster [pixels]
  uint store_pixels;
  uint texels;             // links that a pair has
  uint first_pair, pairs;  // of the table's chunk
  uint first_job;          // of this dispatch
  uint lamps;              // texels from the first on whose light the direct sums hold; 0: leaves them alone
  uint lamps_alike;        // of these, from the first on, that send the same
  uint half_pairs;         // pairs of either half of the directions
};

struct GatherConstants {
  uint texels;
  uint first_pair, pairs;  // of the table's chunk
  uint all_pairs;
  uint first_part, parts;  // of the directions, and round
  uint listed;             // 1: only the workgroups of texels that are listed
};

struct DirectConstants {
  uint texels;
  uint first_pair, pairs;  // of the table's chunk
  uint lamps;              // texels from the first on whose light is summed
  uint half_pairs;         // pairs of either half of the directions
};

struct CoverConstants {
  uint texels;
  uint pairs;     // of the table's first chunk
  uint votes;     // of these pairs
  float contact;  // as far above a texel's plane lies on it [m]
};

struct CheckConstants {
  uint texels, size;       // of the table; of the atlas, a side
  uint first_word, words;  // of a texel: that of the pairs; of their chunk
};

struct ReceiveConstants {
  uint texels;
};

// tone_map: what it has shown last.
struct Exposure {
  float average, white;  // luminances that are middle grey and white [W m^-2 sr^-1]; 0 before the first
  uint adapted;          // 1: they are the light's own
};

struct ExposureConstants {
  float fixed_average;     // above 0: that is middle grey
  float brighter, darker;  // what is kept of the last exposure where the light is brighter, darker: 0..1
};

struct BrdfConstants {
  float emitted;  // 1; 0: without Le
};

struct BounceConstants {
  uint texels;
  uint lamps;          // texels from the first on whose Le is left out: direct light has it
  float direct_scale;  // what w Le is multiplied by in direct sums
  uint counted;        // 1: what has changed is asked for
};

struct ChangeConstants {
  uint texels;
};

// What a solve counts, summed over PSFs.
struct Counters {
  uint rays, misses;                 // of texels that face the light; those that hit nothing
  uint unknown;                      // rays without a pixel on the texel's side of all walls: left out
  uint overflow_pixels, layers_max;  // PSF pixels with more layers than asked for; most layers in one
  uint differing;                    // kept links that are not found again
  uint doubts, rest;                 // rays that route_links leaves to route_doubts, and that to route_rest
};

#ifdef __cplusplus
}  // namespace lichtveld::shaders
#endif
#endif
