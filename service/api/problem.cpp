#include "service/api/problem.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace shadowbench::service {
namespace {

using nlohmann::json;

// Bytes that are not UTF-8, which file names may have, are replaced.
template <class Json>
std::string text_of(const Json& value) {
    return value.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

template <class Json>
ApiResponse answer(int status, const Json& value, const char* type) {
    ApiResponse response;
    response.status = status;
    response.type = type;
    response.headers.push_back({"Cache-Control", "no-store"});
    response.body = text_of(value);
    return response;
}

}  // namespace

const char* title_of(int status) {
    switch (status) {
        case 400:
            return "Bad Request";
        case 401:
            return "Unauthorized";
        case 403:
            return "Forbidden";
        case 404:
            return "Not Found";
        case 405:
            return "Method Not Allowed";
        case 406:
            return "Not Acceptable";
        case 408:
            return "Request Timeout";
        case 409:
            return "Conflict";
        case 413:
            return "Content Too Large";
        case 415:
            return "Unsupported Media Type";
        case 416:
            return "Range Not Satisfiable";
        case 417:
            return "Expectation Failed";
        case 421:
            return "Misdirected Request";
        case 422:
            return "Unprocessable Content";
        case 429:
            return "Too Many Requests";
        case 431:
            return "Request Header Fields Too Large";
        case 500:
            return "Internal Server Error";
        case 501:
            return "Not Implemented";
        case 503:
            return "Service Unavailable";
        case 505:
            return "HTTP Version Not Supported";
        default:
            return "Error";
    }
}

ApiResponse problem(int status, const std::string& detail, const std::vector<ProblemPart>& errors) {
    return problem(status, detail, errors, json::object());
}

ApiResponse problem(int status, const std::string& detail, const std::vector<ProblemPart>& errors,
                    const json& members) {
    json value = {{"type", "about:blank"}, {"title", title_of(status)}, {"status", status}, {"detail", detail}};
    if (!errors.empty()) {
        value["errors"] = json::array();
        for (const ProblemPart& part : errors)
            value["errors"].push_back({{"pointer", part.pointer}, {"detail", part.detail}});
    }
    value.update(members);
    return answer(status, value, problem_type);
}

void add_request_id(ApiResponse& problem, const std::string& id) {
    json value = json::parse(problem.body, nullptr, false);
    if (!value.is_object()) return;
    value["request_id"] = id;
    problem.body = text_of(value);
}

ApiResponse problem_of(const base::Error& error) {
    switch (error.code()) {
        case base::ErrorCode::bad_input:
        case base::ErrorCode::no_such_file:
            return problem_of(std::vector<base::Error>{error});
        case base::ErrorCode::usage:
            return problem(400, error.what());
        case base::ErrorCode::io: {
            ApiResponse response = problem(503, "The server could not read or write a file.");
            response.headers.push_back({"Retry-After", "10"});
            return response;
        }
        case base::ErrorCode::internal:
            break;
    }
    return problem(500, "Internal fault of the server.");
}

ApiResponse problem_of(const std::vector<base::Error>& faults) {
    std::string detail;
    std::vector<ProblemPart> parts;
    for (const base::Error& fault : faults) {
        const bool is_document = fault.where() == "/";  // the document; its pointer is empty
        if (detail.empty()) detail = is_document ? fault.message() : fault.what();
        if (is_document || fault.where().empty())
            parts.push_back({"", fault.message()});
        else if (fault.where().starts_with('/'))
            parts.push_back({fault.where(), fault.message()});
    }
    if (faults.size() > 1) detail += fmt::format(" (the first of {} faults)", faults.size());
    return problem(422, detail, parts);
}

ApiResponse json_answer(int status, const nlohmann::json& value) {
    return answer(status, value, "application/json");
}

ApiResponse json_answer(int status, const nlohmann::ordered_json& value) {
    return answer(status, value, "application/json");
}

}  // namespace shadowbench::service
