// The trials of an exploration, a file each, so that one that was killed goes on where it was:
//   DIR/<hash>.json   {"layout", "of", "setting", "trial", "effort", "result", "checksum"}
// Files appear whole. One counts only for the same question and for what `of` says of the time: the program, the
// machine and its number of threads. So times of another machine never enter an exploration.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "recommend/lab.h"
#include "results/result.h"

namespace shadowbench::recommend {

struct FiledTrial {
    Trial trial;
    // What it adds to what is known of efforts: seconds without the capture, and light rays. 0: its map was there.
    double seconds = 0.0, rays = 0.0;
    results::VariantResult variant;  // one light with one cell
};

class TrialFiles {
public:
    // Reads the folder, and makes it if it is missing. `of`: a result without variants, of the scenario, the program,
    // the machine and the threads; `question`: what else is asked. Throws Error{io}, and Error{bad_input}, place: the
    // file, for one that is damaged.
    TrialFiles(std::filesystem::path folder, results::Result of, const nlohmann::json& question);

    // `setting`: a text that names it. Null if it was not measured; valid as long as this object.
    const FiledTrial* find(const std::string& setting) const;
    // Throws Error{io}.
    void write(const std::string& setting, const FiledTrial& filed) const;

    std::size_t others() const { return others_; }  // files of another question, program or machine

private:
    void read(const std::filesystem::path& file);

    std::filesystem::path folder_;
    results::Result of_;
    std::string key_;  // JSON: `of` of its files
    std::map<std::string, FiledTrial> filed_;
    std::size_t others_ = 0;
};

}  // namespace shadowbench::recommend
