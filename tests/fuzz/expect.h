// Checks on the values that readers return, as the headers of the engine document them.
#pragma once

#include <span>
#include <stdexcept>
#include <string_view>

#include "scene/scene.h"

namespace shadowbench::fuzz {

// A reader returned a value that its header excludes.
class Broken : public std::logic_error {
public:
    using std::logic_error::logic_error;
};

// Throws Broken unless `holds`; `what` states what must hold.
void expect(bool holds, std::string_view what);

void expect_finite(std::span<const float> values, std::string_view what);
void expect_in(std::span<const float> values, float low, float high, std::string_view what);

void expect_sound(const scene::Mesh& mesh);
void expect_sound(const scene::Hair& hair);
void expect_sound(const scene::Spheres& spheres);
void expect_sound(const scene::Particles& particles);
void expect_sound(const scene::AlphaTexture& texture);
void expect_sound(const scene::DeepImage& image);
void expect_sound(const scene::Scenario& scenario);
// The box and step are checked separately, once they are known.
void expect_sound(const scene::GridVolume& volume);
void expect_box(const scene::GridVolume& volume);

}  // namespace shadowbench::fuzz
