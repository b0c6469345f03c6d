#include "service/cli/job_pictures.h"

#include <nlohmann/json.hpp>

#include "render/render.h"
#include "render/write_pictures.h"

namespace shadowbench::service {

std::filesystem::path pictures_folder(const std::filesystem::path& results) {
    return results / "images";
}

bool has_view(const nlohmann::json& variant) {
    return variant.at("scene").contains("objects");
}

std::optional<base::Error> draw_pictures(const nlohmann::json& document, const bench::RunOptions& run,
                                         const std::filesystem::path& folder, const bench::ProgressCallback& progress) {
    try {
        render::write_pictures(folder, render::render(document, render::usual_options(run), progress));
    } catch (const base::Error& error) {
        if (error.code() != base::ErrorCode::bad_input) throw;
        return error;
    }
    return std::nullopt;
}

}  // namespace shadowbench::service
