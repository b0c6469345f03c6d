#include <cstdint>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/json_read.h"
#include "scene/limits.h"
#include "scene/load.h"

namespace shadowbench::scene {
namespace {

Camera load_camera(const json& from) {
    Camera camera;
    read(from, "position", camera.position);
    read(from, "target", camera.target);
    read(from, "up", camera.up);
    read(from, "fov", camera.fov);
    const Vec3d view = camera.target - camera.position;
    if (!(view.length() >= min_length))
        refuse("/receivers/target", "the camera stands at its target; move one of them");
    check_direction(camera.up, "/receivers/up");
    check_not_parallel(camera.up, view, "/receivers/up", "up points along the view");
    return camera;
}

}  // namespace

FilterWidth footprint_width(const json& from) {
    const auto [name, unit] = from.contains("share")    ? std::pair("share", WidthUnit::share)
                              : from.contains("length") ? std::pair("length", WidthUnit::length)
                              : from.contains("receiver_pixels")
                                  ? std::pair("receiver_pixels", WidthUnit::receiver_pixels)
                                  : std::pair("map_pixels", WidthUnit::map_pixels);
    return {unit, from.at(name).get<double>()};
}

FilterWidth load_filter_width(const json& from) {
    FilterWidth width;
    read(from, "filter_width", width.value);
    if (!from.contains("footprint")) return width;
    if (from.contains("filter_width"))
        refuse("/receivers/filter_width", "the footprint is given twice: leave out filter_width or footprint");
    width = footprint_width(from.at("footprint"));
    if (width.unit == WidthUnit::receiver_pixels && from.value("type", "probes") != "camera")
        refuse("/receivers/footprint/receiver_pixels",
               "only receivers of a camera have pixels: give the footprint as a length or a share of the map");
    return width;
}

Receivers load_receivers(const json& from) {
    Receivers receivers;
    if (from.value("type", "probes") == "camera") receivers.camera = load_camera(from);
    read(from, "positions", receivers.points);
    read(from, "resolution", receivers.resolution);
    read(from, "media_lookups", receivers.media_lookups);
    read(from, "count", receivers.count);
    read(from, "seed", receivers.seed);
    receivers.filter_width = load_filter_width(from);
    read(from, "bias", receivers.bias);
    read(from, "slope_bias", receivers.slope_bias);
    read(from, "normal_bias", receivers.normal_bias);
    const auto pixels =
        static_cast<std::uint64_t>(receivers.resolution.x) * static_cast<std::uint64_t>(receivers.resolution.y);
    if (pixels > max_camera_pixels)
        refuse("/receivers/resolution", fmt::format("{} pixels; the limit is {}", pixels, max_camera_pixels));
    const std::uint64_t points = pixels * (static_cast<std::uint64_t>(receivers.media_lookups) + 1);
    if (receivers.camera && points > max_camera_points)
        refuse("/receivers/media_lookups",
               fmt::format("{} pixels of {} places in media are up to {} receivers; the limit is {}: ask for fewer of "
                           "either",
                           pixels, receivers.media_lookups, points, max_camera_points));
    return receivers;
}

}  // namespace shadowbench::scene
