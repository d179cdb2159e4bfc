// How near the direction counts that are meant for use come to the largest one, same bounces.
#include <OpenImageIO/imagebuf.h>
#include <gtest/gtest.h>

#include "commands_run.hpp"
#include "lichtveld/reference/error.hpp"
#include "scene_builder.hpp"

namespace lichtveld::testing {
namespace {

std::vector<glm::vec4> bake(const TempFolder& folder, int size, int psf) {
  const auto file = (folder.path() / "E.exr").string();
  const auto ran = run("bake " + cornell + " --bounces 2 --abuffer list --sort scan --size " +
                           std::to_string(size) + " --psf " + std::to_string(psf) + " --out " + file,
                       "", 300);
  EXPECT_EQ(ran.status, 0) << ran.output;
  std::vector<glm::vec4> values(static_cast<std::size_t>(size) * size);
  OIIO::ImageBuf(file).get_pixels(OIIO::ROI::All(), OIIO::TypeDesc::FLOAT, values.data());
  return values;
}

TEST(Accuracy, Of384DirectionsAgainst6144) {
  const TempFolder folder;
  constexpr int size = 128;
  const double error = reference::error_of(bake(folder, size, 384), bake(folder, size, 6144)).rel_rmse;
  std::printf("rel_rmse of 384 PSFs against 6144 is %.4f\n", error);
  EXPECT_LT(error, 0.12);
}

}  // namespace
}  // namespace lichtveld::testing
