#include "claims/quick.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/read_text.h"
#include "scene/scenario.h"

namespace shadowbench::claims {

FullReport read_full_report(const std::filesystem::path& file) {
    const nlohmann::json document = scene::parse_json(base::read_text(file), file.string());
    FullReport full;
    try {
        full.date = document.at("date").get<std::string>();
        for (const nlohmann::json& paper : document.at("papers"))
            for (const nlohmann::json& claim : paper.at("claims"))
                full.verdicts[{paper.at("id").get<std::string>(), claim.at("where").get<std::string>(),
                               claim.at("says").get<std::string>()}] = claim.at("verdict").get<std::string>();
    } catch (const nlohmann::json::exception&) {
        throw base::Error(base::ErrorCode::bad_input, file.string(), "this is no report of claims");
    }
    return full;
}

void stand_beside(const FullReport& full, PaperReport& quick) {
    for (Claim& claim : quick.claims) {
        const auto found = full.verdicts.find({quick.id, claim.place, claim.says});
        if (found == full.verdicts.end()) {
            claim.why += " The full report has no such claim.";
            continue;
        }
        if (found->second == to_string(claim.judged.verdict)) continue;
        claim.why += fmt::format(" At these smaller sizes it would be \"{}\"; the full report has \"{}\".",
                                 to_string(claim.judged.verdict), found->second);
        claim.judged.verdict = Verdict::undecided;
    }
}

}  // namespace shadowbench::claims
