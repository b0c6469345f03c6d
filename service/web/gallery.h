// Results of many machines, as one page.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace shadowbench::service {

// One measurement of one scenario and light on one machine.
struct GalleryRow {
    std::string scenario, light;                            // the table that it belongs to
    std::string name, date, machine, version;               // of the machine, the day, the processor, the program
    bool settled = false;                                   // the machine was quiet
    std::vector<std::pair<std::string, std::string>> cells;  // technique with its settings, and its times in words
};

// A page of its own, without scripts, that loads nothing: a table for each scenario and light, one row a measurement in
// the given order, one column a technique. It ranks nothing.
std::string gallery_html(const std::vector<GalleryRow>& rows);

}  // namespace shadowbench::service
