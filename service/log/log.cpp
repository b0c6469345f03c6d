#include "service/log/log.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

namespace shadowbench::service {
namespace {

using nlohmann::json;

spdlog::level::level_enum level_of(LogLevel level) {
    switch (level) {
        case LogLevel::debug:
            return spdlog::level::debug;
        case LogLevel::info:
            return spdlog::level::info;
        case LogLevel::warning:
            return spdlog::level::warn;
        case LogLevel::error:
            break;
    }
    return spdlog::level::err;
}

std::string quoted(const std::string& text) {
    return json(text).dump(-1, ' ', true, json::error_handler_t::replace);
}

std::string number(double value) {
    return fmt::format("{:.6g}", value);
}

bool is_plain(const std::string& text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
        return c > ' ' && c < '\x7f' && c != '"' && c != '\\' && c != '=';
    });
}

// Messages may have spaces, but nothing that a terminal or a reader of lines would take for its own.
bool is_printable(const std::string& text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c < '\x7f'; });
}

std::string text_of(const LogEvent& event) {
    std::string line = event.kind;
    if (!event.message.empty()) line += " " + (is_printable(event.message) ? event.message : quoted(event.message));
    for (const auto& [name, value] : event.fields) {
        line += " " + name + "=";
        if (const auto* text = std::get_if<std::string>(&value))
            line += is_plain(*text) ? *text : quoted(*text);
        else if (const auto* whole = std::get_if<std::int64_t>(&value))
            line += std::to_string(*whole);
        else
            line += number(std::get<double>(value));
    }
    return line;
}

// What follows the time and the level in the object of a line.
std::string json_of(const LogEvent& event) {
    std::string line = fmt::format("\"event\":{},\"message\":{}", quoted(event.kind), quoted(event.message));
    for (const auto& [name, value] : event.fields) {
        line += "," + quoted(name) + ":";
        if (const auto* text = std::get_if<std::string>(&value))
            line += quoted(*text);
        else if (const auto* whole = std::get_if<std::int64_t>(&value))
            line += std::to_string(*whole);
        else
            line += std::isfinite(std::get<double>(value)) ? number(std::get<double>(value)) : "null";
    }
    return line;
}

}  // namespace

Log make_log(std::ostream& to, LogFormat format, LogLevel least) {
    auto sink = std::make_shared<spdlog::sinks::ostream_sink_mt>(to, true);
    auto logger = std::make_shared<spdlog::logger>("shadowbench", std::move(sink));
    logger->set_level(level_of(least));
    logger->set_pattern(format == LogFormat::json ? R"({"time":"%Y-%m-%dT%H:%M:%S.%eZ","level":"%l",%v})"
                                                  : "%Y-%m-%dT%H:%M:%S.%eZ %l %v",
                        spdlog::pattern_time_type::utc);
    logger->set_error_handler([](const std::string&) {});  // a log that cannot be written stops no work
    return [logger, format](const LogEvent& event) {
        const spdlog::level::level_enum level = level_of(event.level);
        if (!logger->should_log(level)) return;
        logger->log(level, spdlog::string_view_t(format == LogFormat::json ? json_of(event) : text_of(event)));
    };
}

}  // namespace shadowbench::service
