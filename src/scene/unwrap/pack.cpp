#include "pack.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#define STB_RECT_PACK_IMPLEMENTATION
#define STBRP_STATIC
#include <stb_rect_pack.h>

namespace lichtveld::scene {

bool pack(std::vector<Rectangle>& rectangles, std::uint32_t size) {
  std::uint64_t area = 0;
  for (const auto& rectangle : rectangles) {
    if (rectangle.width > size || rectangle.height > size) return false;
    area += std::uint64_t{rectangle.width} * rectangle.height;
  }
  if (area > std::uint64_t{size} * size) return false;
  std::vector<stbrp_rect> rects(rectangles.size());
  for (std::size_t i = 0; i < rects.size(); ++i) {
    rects[i].id = static_cast<int>(i);
    rects[i].w = static_cast<stbrp_coord>(rectangles[i].width);
    rects[i].h = static_cast<stbrp_coord>(rectangles[i].height);
  }
  // It sorts by these two with qsort, which leaves the order of equals open.
  std::ranges::sort(rects, {}, [](const stbrp_rect& rect) { return std::tuple(-rect.h, -rect.w, rect.id); });
  std::vector<stbrp_node> nodes(size);
  stbrp_context context;
  stbrp_init_target(&context, static_cast<int>(size), static_cast<int>(size), nodes.data(),
                    static_cast<int>(nodes.size()));
  if (!stbrp_pack_rects(&context, rects.data(), static_cast<int>(rects.size()))) return false;
  for (const auto& rect : rects) {
    auto& rectangle = rectangles[static_cast<std::size_t>(rect.id)];
    rectangle.x = static_cast<std::uint32_t>(rect.x);
    rectangle.y = static_cast<std::uint32_t>(rect.y);
  }
  return true;
}

}  // namespace lichtveld::scene
