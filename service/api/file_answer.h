// Files and embedded text as answers: type by name, ETag, If-None-Match, one Range.
#pragma once

#include <filesystem>
#include <string>

#include "service/api/message.h"

namespace shadowbench::service {

// 200, 206, 304 or 416; 404 when it is not there, or no regular file (a link is none).
ApiResponse file_answer(const ApiRequest& request, const std::filesystem::path& file);

// The media type of a file's name; "application/octet-stream" when it is none of those that jobs write.
const char* type_of_file(const std::filesystem::path& file);

// Of a text that is the same as long as this program runs.
ApiResponse text_answer(const ApiRequest& request, const std::string& type, std::string text);

// The bytes of such an answer. Throws Error{io}.
std::string read_all(const FilePart& part);

}  // namespace shadowbench::service
