// The file with the tokens of a server.
#pragma once

#include <string>
#include <vector>

#include "service/jobs/jobs.h"

namespace shadowbench::service {

struct NamedToken {
    std::string name;  // empty: the only token of a file without names
    std::string token;
    OwnerLimits limits = {};
};

// Each line is "TOKEN", or "NAME TOKEN" with any of "queued=N", "running=N" and "bytes=N" after it; bytes may end in K,
// M, G or T. Empty lines and those that begin with # are passed over. Throws Error: no_such_file; io; bad_input when
// others can read the file, for a token of less than 16 characters, and for a line of another form.
std::vector<NamedToken> read_tokens(const std::string& file);

// The first token of the file, for a client.
std::string read_token(const std::string& file);

}  // namespace shadowbench::service
