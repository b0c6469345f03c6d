#include "results/report.h"

#include <nlohmann/json.hpp>

#include "fuzz/expect.h"
#include "fuzz/target.h"
#include "scene/scenario.h"

namespace shadowbench::fuzz {

void result(std::string_view bytes) {
    attempt({base::ErrorCode::bad_input}, [&] {
        scene::parse_json(std::string(bytes), "result");
        const results::Result read = results::from_json(nlohmann::ordered_json::parse(bytes));
        bench::to_table(read);
        results::to_csv(read);
        const nlohmann::ordered_json written = bench::to_json(read);
        expect(bench::to_json(results::from_json(written)) == written, "what is written is read back");
    });
}

}  // namespace shadowbench::fuzz
