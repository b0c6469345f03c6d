#include "service/web/report.h"

#include <cstdint>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/read_text.h"
#include "service/web/document.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string base64(const std::string& bytes) {
    constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63u] : '=';
    }
    return text;
}

void add_picture(json& pictures, const fs::path& folder, const std::string& name) {
    const fs::path file = folder / name;
    // Only file names, no paths; and no links, which could lead to any file.
    if (fs::path(name).filename() != name || fs::symlink_status(file).type() != fs::file_type::regular) return;
    if (file.extension() == ".png") pictures[name] = "data:image/png;base64," + base64(base::read_bytes(file));
}

void add_pictures(json& pictures, const fs::path& folder, const json& of) {
    for (const json& name : of.value("files", json::array())) add_picture(pictures, folder, name.get<std::string>());
}

json read_images(const fs::path& file) {
    if (!fs::exists(file)) return nullptr;
    try {
        return json::parse(base::read_text(file));
    } catch (const json::exception&) {
        throw base::Error(base::ErrorCode::bad_input, file.string(), "not the JSON that render writes");
    }
}

}  // namespace

std::string report_html(const json& result, const fs::path& images) {
    const fs::path file = images / "images.json";
    json data = {{"result", result}, {"images", read_images(file)}, {"pictures", json::object()}};
    try {
        if (!data["images"].is_null()) {
            add_pictures(data["pictures"], images, data["images"].at("reference"));
            for (const json& technique : data["images"].at("techniques"))
                add_pictures(data["pictures"], images, technique);
        }
    } catch (const json::exception&) {
        throw base::Error(base::ErrorCode::bad_input, file.string(), "not the JSON that render writes");
    }
    const auto name = result.is_object() ? result.find("name") : result.end();
    const bool named = result.is_object() && name != result.end() && name->is_string();
    return document((named ? name->get<std::string>() : "unnamed") + " · shadowbench", "/assets/report.js", data);
}

}  // namespace shadowbench::service
