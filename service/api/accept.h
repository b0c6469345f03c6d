// Reads the header fields of a request that choose its answer: Accept, Accept-Encoding, If-None-Match.
#pragma once

#include <string>

#include "service/api/message.h"

namespace shadowbench::service {

// "Application/JSON; charset=utf-8" -> "application/json".
std::string media_type(const std::string& value);

// Whether the client accepts this media type. Without Accept it accepts all (RFC 9110, 12.5.1).
bool accepts(const ApiRequest& request, const std::string& type);

// Whether the client accepts gzip.
bool accepts_gzip(const ApiRequest& request);

// Whether If-None-Match names this ETag.
bool has_version(const ApiRequest& request, const std::string& etag);

}  // namespace shadowbench::service
