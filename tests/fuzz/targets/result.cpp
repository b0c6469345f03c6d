#include "results/report.h"

#include <nlohmann/json.hpp>

#include "fuzz/expect.h"
#include "fuzz/target.h"
#include "results/sweep_cell.h"
#include "scene/scenario.h"

namespace shadowbench::fuzz {

void result(std::string_view bytes) {
    attempt({base::ErrorCode::bad_input}, [&] {
        const results::Result read = results::from_json(scene::parse_json(std::string(bytes), "result"), "");
        results::to_table(read);
        results::to_fitting_table(read, {60, true});
        results::meaning_text(read);
        results::to_csv(read);
        const nlohmann::ordered_json written = results::to_json(read);
        const results::Result again = results::from_json(nlohmann::json::parse(written.dump()), "");
        expect(results::to_json(again) == written, "what is written is read back");
    });
    attempt({base::ErrorCode::bad_input},
            [&] { results::cell_from_json(scene::parse_json(std::string(bytes), "cell"), "cell"); });
}

}  // namespace shadowbench::fuzz
