#include <string>

#include "base/error.h"
#include "techniques/avsm/avsm.h"
#include "techniques/deep/deep.h"
#include "techniques/depth/depth.h"
#include "techniques/fourier/fourier.h"
#include "techniques/opacity/opacity.h"
#include "techniques/multi_depth/multi_depth.h"
#include "techniques/ray_traced/ray_traced.h"
#include "techniques/technique.h"
#include "techniques/uncompressed/uncompressed.h"
#include "techniques/volume_deep/volume_deep.h"

namespace shadowbench::techniques {

std::span<const Technique> all() {
    static const Technique rows[] = {
        shadow_map(),    // Williams 1978
        pcf(),           // Reeves, Salesin, Cook 1987
        deep(),          // Lokovic, Veach 2000
        multi_depth(),   // Pagot, Comba, Oliveira 2004
        volume_deep(),   // Deep Shadow Maps from Volumetric Data
        avsm(),          // Salvi et al. 2010
        opacity(),       // Kim, Neumann 2001
        fourier(),       // Jansen, Bavoil 2010
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
