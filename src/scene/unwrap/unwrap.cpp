#include "lichtveld/scene/unwrap.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "atlas_packing.hpp"
#include "charts.hpp"
#include "mesh_writer.hpp"
#include "model.hpp"
#include "parts.hpp"
#include "plain_file.hpp"
#include "sheets.hpp"
#include "sky.hpp"

namespace lichtveld::scene {
namespace {

// Texels of an atlas are filled by about so large a share, and two cells lie in one along each axis.
constexpr double usual_fill = 0.6, cells_in_texel = 2;
// Of larger atlases no smaller cells are looked at.
constexpr std::uint32_t finest_cells = 512;

// Charts of all sheets; the number of triangles of their own charts that could not be kept.
std::size_t lay_flat(Meshes& meshes, std::uint32_t size) {
  double area = 0;
  for (const auto& [number, mesh] : meshes)
    for (std::size_t s = 0; s < mesh.sheets.size(); ++s)
      for (const auto& use : mesh.uses) area += area_in_world(mesh, s, use) * use.density * use.density;
  const double side = std::sqrt(area / usual_fill);  // of the atlas [m]
  std::size_t anew = 0;
  for (auto& [number, mesh] : meshes)
    for (std::size_t s = 0; s < mesh.sheets.size(); ++s) {
      Sheet& sheet = mesh.sheets[s];
      double scale = 0;
      for (const auto& use : mesh.uses) scale = std::max(scale, scale_of(mesh, s, use));
      if (!(scale > 0)) continue;
      const ChartLimits limits{.cell = side / std::min(size, finest_cells) / cells_in_texel / scale,
                               .longest = side / scale};
      const std::span<const Corners> fronts(sheet.corners.data(), sheet.fronts);
      if (sheet.own.empty()) {
        sheet.charts = find_charts(sheet.corners, limits);
        continue;
      }
      sheet.charts = charts_of(fronts, sheet.own, limits, anew);
      for (auto& chart : find_charts(std::span(sheet.corners).subspan(sheet.fronts), limits)) {
        for (auto& t : chart.triangles) t += static_cast<std::uint32_t>(sheet.fronts);
        sheet.charts.push_back(std::move(chart));
      }
    }
  return anew;
}

bool has_triangles(const Meshes& meshes) {
  return std::ranges::any_of(meshes, [](const auto& entry) {
    return std::ranges::any_of(entry.second.sheets,
                               [](const Sheet& sheet) { return std::ranges::any_of(sheet.corners, has_area); });
  });
}

}  // namespace

std::optional<Unwrapped> unwrap(const std::filesystem::path& file, const tinygltf::Model& model,
                                const UnwrapOptions& options) {
  Meshes meshes = used_meshes(model);
  Unwrapped result;
  result.reason = fault_of(meshes);
  if (result.reason.empty()) return std::nullopt;
  add_backs(meshes);
  const std::size_t anew = lay_flat(meshes, options.size);
  if (anew > 0)
    result.reason +=
        "; " + std::to_string(anew) + " triangles of its charts fold or have no area, and are laid anew";
  std::vector<Spot> spots;
  for (const auto& [number, mesh] : meshes)
    for (const auto& use : mesh.uses)
      for (std::size_t s = 0; s < mesh.sheets.size(); ++s) {
        const double scale = scale_of(mesh, s, use);
        for (const auto& chart : mesh.sheets[s].charts) spots.push_back({&chart, scale});
      }
  if (spots.empty()) return std::nullopt;  // load() says what is wrong
  const Atlas atlas = packed(spots, options);
  MeshWriter writer(document_of(file), model);
  std::size_t spot = 0;
  for (const auto& [number, mesh] : meshes) writer.add(number, mesh, atlas, spot);
  if (!options.light_map.empty()) writer.name_light_map(options.light_map);
  result.glb = writer.finish();
  result.size = atlas.size;
  result.charts = spots.size();
  result.texels_per_metre = atlas.density;
  result.coverage = coverage_of(atlas);
  return result;
}

Unwrapped unwrap(const std::filesystem::path& file, const UnwrapOptions& options) {
  return naming(file, [&] {
    Remarks remarks;  // load() tells them
    const auto model = read_model(file, remarks);
    Unwrapped result;
    if (auto made = unwrap(file, model, options)) {
      result = std::move(*made);
    } else if (!has_triangles(used_meshes(model))) {
      throw SceneError(nothing_to_light);
    } else {
      PlainFile plain(document_of(file), model);
      if (!options.light_map.empty()) plain.name_light_map(options.light_map);
      result.glb = plain.finish();
    }
    if (!model.scenes.empty())
      result.beside = sky_file_of(model.scenes[static_cast<std::size_t>(scene_of(model))].extras);
    return result;
  });
}

std::string summary_of(const Unwrapped& unwrapped) {
  return fmt::format("unwrapped into {} charts at {:.3g} texels a metre, {:.0f} % of {} x {} texels, as {}",
                     unwrapped.charts, unwrapped.texels_per_metre, 100 * unwrapped.coverage, unwrapped.size,
                     unwrapped.size, unwrapped.reason);
}

}  // namespace lichtveld::scene
