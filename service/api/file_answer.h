// Answers with files and with texts of the program: media type, ETag, If-None-Match, one Range.
#pragma once

#include <filesystem>
#include <string>

#include "service/api/message.h"

namespace shadowbench::service {

// The answer 200, 206, 304 or 416; 404 when there is no such file, or it is not a regular file (a link is not).
ApiResponse file_answer(const ApiRequest& request, const std::filesystem::path& file);

// The media type of a file by its extension; "application/octet-stream" for one that jobs do not write.
const char* type_of_file(const std::filesystem::path& file);

// The answer 200 or 304 with a text that does not change while this program runs.
ApiResponse text_answer(const ApiRequest& request, const std::string& type, std::string text);

// The bytes of a file's part. Throws Error{io}.
std::string read_all(const FilePart& part);

}  // namespace shadowbench::service
