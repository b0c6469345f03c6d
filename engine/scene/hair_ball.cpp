#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/parallel.h"
#include "base/random.h"
#include "scene/procedural.h"
#include "scene/turn.h"

namespace shadowbench::scene {
namespace {

constexpr int hairs_a_tuft = 60;
constexpr double golden_turn = 0.61803398874989484820;

// Hairs whose roots share a patch of the ball and which lean and curl together.
struct Tuft {
    Vec3d middle;  // unit, from the ball's centre
    Vec3d lean;    // unit; the direction of its hairs' tips
    double patch;  // radius of the roots' patch on the unit ball
    double phase;  // of its curls, in turns
};

Tuft make_tuft(std::uint64_t seed, std::uint64_t index, std::uint64_t count) {
    base::Random random(base::hash(seed, 1, index));
    // A Fibonacci lattice (Gonzalez, Measurement of Areas on a Sphere, 2010) covers the ball evenly.
    const double height = 1.0 - (2.0 * static_cast<double>(index) + 1.0) / static_cast<double>(count);
    const double ring = std::sqrt(std::max(0.0, 1.0 - height * height));
    const Turn around = turn(golden_turn * static_cast<double>(index) + base::to_unit(base::hash(seed, 2)));
    Tuft tuft;
    tuft.middle = Vec3d(ring * around.cosine, height, ring * around.sine);
    // Patches that only just cover the ball would leave bald seams, so they overlap a little.
    tuft.patch = 1.25 * 2.0 / std::sqrt(static_cast<double>(count));
    const Across side = across(tuft.middle);
    const Vec2d tilt = in_disc(random) * 0.3;
    tuft.lean = (tuft.middle + side.u * tilt.x + side.v * tilt.y).normalized();
    tuft.phase = random.uniform();
    return tuft;
}

void grow(const HairBall& ball, const Tuft& tuft, std::uint64_t strand, Vec3f* points, float* radii) {
    base::Random random(base::hash(ball.seed, 3, strand));
    const Across patch = across(tuft.middle);
    const Vec2d at = in_disc(random) * std::min(tuft.patch, 2.0);
    const Vec3d root = (tuft.middle + patch.u * at.x + patch.v * at.y).normalized();
    const Across side = across(root);
    const double length = ball.length * random.uniform(0.85, 1.15);
    const double phase = tuft.phase + (1.0 - 0.85 * ball.clumping) * random.uniform();
    const double curl = ball.curl_radius * random.uniform(0.7, 1.3);
    for (int i = 0; i <= ball.segments; ++i) {
        const double s = static_cast<double>(i) / ball.segments;
        const Vec3d axis = (root + (tuft.lean - root) * (ball.clumping * s)).normalized();
        // The helix opens within the first third, so that roots stay in place.
        const double open = std::min(1.0, 3.0 * s);
        const Turn turned = turn(phase + ball.curls * s);
        const Vec3d offset = (side.u * turned.cosine + side.v * turned.sine) * (curl * open);
        points[i] = Vec3f(ball.centre + axis * (ball.ball_radius + length * s) + offset);
        radii[i] = static_cast<float>(ball.radius * (1.0 - 0.75 * s));
    }
}

}  // namespace

Hair make_hair_ball(const HairBall& parameters) {
    const auto strands = static_cast<std::size_t>(parameters.strands);
    const std::size_t per_strand = static_cast<std::size_t>(parameters.segments) + 1;
    const std::size_t tufts = std::max<std::size_t>(1, strands / hairs_a_tuft);
    Hair hair;
    hair.points.resize(strands * per_strand);
    hair.radii.resize(strands * per_strand);
    hair.strand_begin.resize(strands + 1);
    for (std::size_t s = 0; s <= strands; ++s) hair.strand_begin[s] = static_cast<std::uint32_t>(s * per_strand);
    base::parallel_for(tufts, [&](std::size_t t) {
        const Tuft tuft = make_tuft(parameters.seed, t, tufts);
        for (std::size_t s = t; s < strands; s += tufts)
            grow(parameters, tuft, s, &hair.points[s * per_strand], &hair.radii[s * per_strand]);
    });
    return hair;
}

}  // namespace shadowbench::scene
