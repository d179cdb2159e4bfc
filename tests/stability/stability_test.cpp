// Every case by each method: thesis with both A-buffers, rays, and the reference.
//   test_stability [--markdown FILE]
#include <gtest/gtest.h>

#include <cmath>

#include "device_for_tests.hpp"
#include "lichtveld/reference/path_tracer.hpp"
#include "light_fields.hpp"
#include "stability_table.hpp"

namespace lichtveld::stability {

double outline_error(double directions) {
  return 2 * std::pow(directions, -0.75);
}

namespace {

Table table;

double error(double value, double expected) {
  const double result = expected == 0 ? std::abs(value) : std::abs(value / expected - 1);
  return std::isnan(result) ? std::numeric_limits<double>::infinity() : result;
}

class Stability : public testing::WithDevice, public ::testing::WithParamInterface<Case> {
 protected:
  Texels baked(const Case& of, const scene::Scene& scene, Method method) {
    if (method == reference) {
      const auto light =
          lichtveld::reference::trace(scene, {}, {.size = of.size, .bounces = of.bounces, .spp = of.spp});
      return testing::texels(scene, of.size, light.texels, light.standard_error);
    }
    const auto light = lightfield::make_light_field(
        method == rays ? "rays" : "thesis", device(), scene,
        {.size = of.size,
         .psf = of.psf,
         .bounces = of.bounces,
         .thesis = {.abuffer = method == stencil ? lightfield::ABuffer::stencil : lightfield::ABuffer::list,
                    .sort = lightfield::Sort::scan}});
    light->settle();
    return testing::texels(scene, of.size, light->irradiance(), {});
  }

  std::vector<Row> measured(const Case& of) {
    std::vector<Row> rows;
    for (const auto& figure : of.figures) rows.push_back({of.name, figure, {}, {-1, -1, -1, -1}});
    for (const auto& scene : of.scenes())
      for (const auto method : {stencil, list, rays, reference}) {
        const auto map = baked(of, scene, method);
        for (auto& row : rows) {
          const double value = row.figure.value(map), off = error(value, row.figure.expected);
          if (off <= row.errors[method]) continue;
          row.values[method] = value;
          row.errors[method] = off;
        }
      }
    return rows;
  }
};

TEST_P(Stability, HoldsItsTolerances) {
  const auto rows = measured(GetParam());
  table.add(GetParam(), rows);
  for (const auto& row : rows)
    for (const auto method : {stencil, list, rays, reference}) {
      const auto& limit = row.figure.limits[method];
      const auto what = row.name + ", " + row.figure.measured + ", " + method_names[method] + ": " +
                        std::to_string(row.values[method]) + " instead of " +
                        std::to_string(row.figure.expected);
      if (!limit.known) {
        EXPECT_LE(row.errors[method], limit.tolerance) << what << ". Tolerance: " << row.figure.reason;
        continue;
      }
      EXPECT_LE(row.errors[method], *limit.known) << what << ". A known failure has got worse";
      EXPECT_GT(row.errors[method], limit.tolerance)
          << what << ". A known failure is cured: strike it from its case and from docs/limits.md";
    }
}

std::string name_of(const ::testing::TestParamInfo<Case>& info) {
  return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(Energy, Stability, ::testing::ValuesIn(energy_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(Factors, Stability, ::testing::ValuesIn(factor_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(Lamps, Stability, ::testing::ValuesIn(lamp_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(Separation, Stability, ::testing::ValuesIn(separation_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(Meshes, Stability, ::testing::ValuesIn(mesh_cases()), name_of);

}  // namespace
}  // namespace lichtveld::stability

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  const auto status = RUN_ALL_TESTS();
  const auto& table = lichtveld::stability::table;
  if (table.empty()) return status;  // --gtest_list_tests
  table.print();
  if (argc == 3 && std::string(argv[1]) == "--markdown") table.write_markdown(argv[2]);
  return status;
}
