// A direction's orthographic view of the scene.
#pragma once

#include "lichtveld/lightfield/directions.hpp"
#include "lichtveld/scene/scene.hpp"
#include "shared.h"

namespace lichtveld::lightfield {

// The scene's sphere seen along a direction, with the direction's roll and jitter. It is scaled to fill the
// unit sphere but for the half pixel that a raster of `pixels` a side may be shifted by.
shaders::PsfView psf_view(const Direction& direction, const scene::Sphere& sphere, std::uint32_t pixels);

}  // namespace lichtveld::lightfield
