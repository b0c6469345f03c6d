// Header fields about media types and versions of what is here.
#pragma once

#include <string>

#include "service/api/message.h"

namespace shadowbench::service {

// "Application/JSON; charset=utf-8" -> "application/json".
std::string media_type(const std::string& value);

// Whether the client takes this type; one without Accept takes all.
bool accepts(const ApiRequest& request, const std::string& type);

// Whether the client takes gzip.
bool accepts_gzip(const ApiRequest& request);

// Whether If-None-Match names this ETag.
bool has_version(const ApiRequest& request, const std::string& etag);

}  // namespace shadowbench::service
