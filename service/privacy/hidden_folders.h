// The folders of the server's machine, which clients do not learn. Every text that may name a path goes through hide()
// before it leaves the server.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"

namespace shadowbench::service {

// A folder, and the words that a client reads in its place.
struct HiddenFolder {
    std::string path;  // without a slash at its end
    std::string name;
};

// The state folder (empty: none) and the data folders: as they are written, absolute, and without links; longest first.
std::vector<HiddenFolder> hidden_folders(const std::string& state, const std::vector<std::string>& data);

// How hide() treats absolute paths outside of the hidden folders. The engine's texts name no others, and their JSON
// pointers look like paths: keep. A text of another program, such as a backtrace, may name any: last_part.
enum class OtherPaths { keep, last_part };

// The rule: a path in a hidden folder begins behind it ("/srv/data/hair/ball.tfx:12" -> "hair/ball.tfx:12"), and the
// folder itself becomes its name ("in /srv/data" -> "in the data folder"). Names that only contain such a path
// ("/srv/database", "/mnt/srv/data") stay.
std::string hide(const std::string& text, const std::vector<HiddenFolder>& folders,
                 OtherPaths others = OtherPaths::keep);

// The same error with its place and its message by that rule.
base::Error hide(const base::Error& error, const std::vector<HiddenFolder>& folders);

}  // namespace shadowbench::service
