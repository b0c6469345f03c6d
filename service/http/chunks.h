// Reads the chunked coding of a body strictly (RFC 9112, 7.1): what could be understood in two ways is refused.
#pragma once

#include <cstddef>
#include <functional>

namespace shadowbench::service {

// Reads a chunked body to its end, with its trailers, which are skipped as extensions of chunks are. `read` reads as
// recv() does; `take` gets the data piece by piece. Returns false for a malformed body, at a fault or an early end of
// `read`, and once `take` does.
bool read_chunks(const std::function<long(char* to, std::size_t size)>& read,
                 const std::function<bool(const char* bytes, std::size_t size)>& take);

}  // namespace shadowbench::service
