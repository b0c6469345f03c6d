#include "claims/salvi_columns.h"

#include <nlohmann/json.hpp>

namespace shadowbench::claims::salvi {
namespace {

// Multiplies this property of all objects of the scene that have it.
void multiply(nlohmann::json& document, const char* property, double factor) {
    for (nlohmann::json& object : document.at("scene").at("objects"))
        if (object.contains(property)) object[property] = object[property].get<double>() * factor;
}

}  // namespace

nlohmann::json with_spacing(nlohmann::json document, double spacing) {
    nlohmann::json& objects = document.at("scene").at("objects");
    for (const int i : {0, 2})
        for (const int axis : {0, 2}) {
            nlohmann::json& place = objects.at(i).at("base").at(axis);
            place = place.get<double>() * spacing / own_spacing;
        }
    nlohmann::json& height = document.at("lights").at(0).at("direction").at(1);
    height = height.get<double>() * own_spacing / spacing;
    return document;
}

nlohmann::json with_camera_away(nlohmann::json document, double times) {
    nlohmann::json& camera = document.at("receivers");
    for (const std::size_t axis : {0u, 1u, 2u}) {
        const double target = camera.at("target").at(axis).get<double>();
        nlohmann::json& place = camera.at("position").at(axis);
        place = target + times * (place.get<double>() - target);
    }
    return document;
}

nlohmann::json with_density(nlohmann::json document, double density) {
    multiply(document, "extinction", density);
    return document;
}

nlohmann::json with_opacity(nlohmann::json document, double opacity) {
    multiply(document, "opacity", opacity);
    return document;
}

}  // namespace shadowbench::claims::salvi
