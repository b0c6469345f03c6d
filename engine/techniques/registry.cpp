#include <string>

#include "base/error.h"
#include "techniques/avsm/avsm.h"
#include "techniques/deep/deep.h"
#include "techniques/depth/depth.h"
#include "techniques/multi_depth/multi_depth.h"
#include "techniques/ray_traced/ray_traced.h"
#include "techniques/technique.h"
#include "techniques/uncompressed/uncompressed.h"

namespace shadowbench::techniques {

std::span<const Technique> all() {
    static const Technique rows[] = {
        shadow_map(),    // Williams 1978
        pcf(),           // Reeves, Salesin, Cook 1987
        deep(),          // Lokovic, Veach 2000
        multi_depth(),   // Pagot, Comba, Oliveira 2004
        avsm(),          // Salvi et al. 2010
        uncompressed(),  // the truth of the rays
        ray_traced(),    // no map
    };
    return rows;
}

const Technique& find(const std::string& id, const std::string& where) {
    std::string names;
    for (const Technique& row : all()) {
        if (id == row.id) return row;
        names += (names.empty() ? "" : ", ") + std::string(row.id);
    }
    throw base::Error(base::ErrorCode::bad_input, where, "unknown technique \"" + id + "\"; there are: " + names);
}

void NodeStats::add(std::uint32_t nodes) {
    ++cells;
    total += nodes;
    if (nodes >= histogram.size()) histogram.resize(nodes + 1, 0);
    ++histogram[nodes];
    if (nodes > max) max = nodes;
}

}  // namespace shadowbench::techniques
