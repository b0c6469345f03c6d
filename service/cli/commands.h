// The commands that measure and read or write files, with their parsed arguments. Each throws base::Error.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "service/cli/output.h"

namespace shadowbench::service {

// Techniques from outside.
struct LibraryArguments {
    std::vector<std::string> files;
    bool isolate = false;        // each map in a process of its own
    double call_seconds = 60.0;  // that one call may take there
    // Of a server's processes: "FILE\nREASON", libraries that the server could not use. They are not opened again.
    std::vector<std::string> unusable = {};
};

struct JobArguments {
    std::vector<std::string> set;   // path=value
    std::vector<std::string> data;  // folders
    std::vector<std::string> only;  // technique ids
    int threads = 0;                // 0: all processors
    double memory_limit = 16.0;     // GiB
    LibraryArguments libraries;
};

struct ScenarioArguments : JobArguments {
    std::string scenario;  // a path, or the name of one in the scenario folders
};

struct RunArguments : JobArguments {
    std::vector<std::string> scenarios;  // paths or names, of scenarios or of folders with scenarios
    std::string out;                     // folder; empty: results/runs/<scenario name>
    std::string verdicts;                // file; empty: verdicts.md beside the results, if there are several scenarios
    std::string shard;                   // "i/n"; empty: everything
    bool pictures = false;               // draw what render draws, into images/ in the folder of the results
    OutputArguments output;
};

struct RenderArguments : ScenarioArguments {
    std::string out;                   // folder; empty: results/images/<scenario name>
    std::string size;                  // WIDTHxHEIGHT; empty: the scenario's own, enlarged if it is small
    std::optional<int> rays_per_side;  // its square is the number of view rays per pixel; absent: as usual
    std::optional<int> media_lookups;  // lookups per view ray, over all media; absent: as usual
};

struct ExportArguments : ScenarioArguments {
    std::string technique = "deep";  // id:name=value,name=value
    std::string light;               // a name, or a number, from 0; empty: the first
    std::string out;                 // .exr or .dsm
    bool rays = false;               // write the light rays instead of a map
    int tile = 16;                   // side in pixels, only for .dsm
};

struct CurveArguments {
    std::string functions;
    std::vector<std::string> techniques;
    std::string dump;  // file; empty: none
    bool json = false;
    int repetitions = 7;
};

struct ReproduceArguments {
    std::string paper = "all";      // a paper's id, or all
    std::string out;                // folder; empty: results/
    std::vector<std::string> data;  // folders
    bool quick = false;
    int threads = 0;  // 0: all processors
};

struct ReportArguments {
    std::string folder;  // with result.json
    std::string images;  // folder with images.json; empty: images/ in that folder
    std::string out;     // file; empty: report.html in that folder
};

// Returns whether every technique kept its promises in every scenario.
bool run_command(const RunArguments& arguments, std::ostream& out, std::ostream& err);
// Returns whether no technique failed.
bool render_command(const RenderArguments& arguments, std::ostream& out, std::ostream& err);
// Writes one light's map, or its light rays, to a file.
void export_command(const ExportArguments& arguments, std::ostream& out, std::ostream& err);
// Throws the last fault of the scenario; the others go to `err`, a line each.
void validate_command(const ScenarioArguments& arguments, std::ostream& out, std::ostream& err);
void list_techniques(const LibraryArguments& libraries, std::ostream& out);
void list_scenarios(std::ostream& out);
void reproduce_command(const ReproduceArguments& arguments, std::ostream& out, std::ostream& err);
void curve_command(const CurveArguments& arguments, std::ostream& out);
void report_command(const ReportArguments& arguments, std::ostream& out);

}  // namespace shadowbench::service
