#include <chrono>
#include <functional>
#include <ostream>
#include <random>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/read_text.h"
#include "document/document.h"
#include "scene/scenario.h"
#include "service/cli/progress_bar.h"
#include "service/cli/quantity.h"
#include "service/cli/scenario_files.h"
#include "service/cli/server_commands.h"
#include "service/cli/token_file.h"
#include "service/http/client.h"

namespace shadowbench::service {
namespace {

using base::Error;
using base::ErrorCode;
using json = nlohmann::ordered_json;

constexpr std::chrono::milliseconds between_looks{500};
constexpr std::chrono::seconds patience{60};  // longest wait for a server that does not answer

ErrorCode code_of(int status) {
    switch (status) {
        case 400:
        case 413:
        case 415:
        case 422:
            return ErrorCode::bad_input;
        case 401:
        case 403:
        case 421:
            return ErrorCode::usage;
        case 404:
            return ErrorCode::no_such_file;
        default:
            return ErrorCode::io;
    }
}

// The JSON of an answer with this status. Throws the problem that any other answer describes.
json take(const Reply& reply, int status, const std::string& server) {
    json value = json::parse(reply.body, nullptr, false);
    if (reply.status == status && !value.is_discarded()) return value;
    std::string where = server, message = fmt::format("the server answered with status {}", reply.status);
    if (value.is_object() && value.contains("detail")) message = value.value("detail", message);
    if (value.is_object() && value.contains("errors") && !value["errors"].empty()) {
        where = value["errors"][0].value("pointer", where);
        message = value["errors"][0].value("detail", message);
        if (const std::size_t more = value["errors"].size() - 1; more > 0)
            message += fmt::format(" (and {} more; run shadowbench validate to see all)", more);
    }
    throw Error(code_of(reply.status), where, message);
}

std::string without_slash(const std::string& url) {
    return url.substr(0, url.find_last_not_of('/') + 1);
}

std::string request_body(const SubmitArguments& arguments) {
    const auto file = find_scenario(arguments.scenario);
    nlohmann::json document = scene::parse_json(base::read_text(file), file.string());
    for (const std::string& assignment : arguments.set) document::set_value(document, assignment);
    nlohmann::json body = {{"scenario", std::move(document)},
                           {"options", {{"cache", arguments.fresh ? "fresh" : "reuse"}}}};
    if (!arguments.labels.empty()) body["options"]["labels"] = arguments.labels;
    if (arguments.priority != 0) body["options"]["priority"] = arguments.priority;
    if (arguments.recommend) {
        body["recommend"] = {{"error", *arguments.recommend}};
        if (!arguments.budget.empty())
            body["recommend"]["budget"] = read_quantity(arguments.budget, second_units, "--budget");
    } else
        body["options"]["pictures"] = !arguments.no_pictures;
    return body.dump();
}

void show(const json& job, ProgressBar& bar) {
    const json& progress = job.at("progress");
    if (!progress.is_object()) return;
    const std::string stage = progress.at("stage");
    bar.show({progress.at("place"), stage.c_str(), progress.at("done"), progress.at("total")});
}

// The answer of a server that may not answer, or be busy, for a while: because it restarts, or its queue is full.
Reply patiently(const std::function<Reply()>& ask, const std::string& server, std::ostream& err) {
    const auto end = std::chrono::steady_clock::now() + patience;
    for (bool reported = false;; reported = true) {
        std::string why = "it is busy, stopping, or not there behind its proxy";
        try {
            Reply reply = ask();
            const bool later = reply.status == 429 || reply.status == 502 || reply.status == 503 || reply.status == 504;
            if (!later || std::chrono::steady_clock::now() > end) return reply;
        } catch (const Error& error) {
            // No other try would mend a wrong URL or certificate.
            if (error.code() != ErrorCode::io || std::chrono::steady_clock::now() > end) throw;
            why = error.message();
        }
        if (!reported)
            err << fmt::format("shadowbench: {}: {}; trying again for {} s\n", server, why, patience.count())
                << std::flush;
        std::this_thread::sleep_for(between_looks);
    }
}

json wait_for(Client& client, json job, const std::string& server, std::ostream& err) {
    const std::string self = job.at("links").at("self");
    ProgressBar bar(err);
    while (job.at("state") == "queued" || job.at("state") == "running") {
        show(job, bar);
        std::this_thread::sleep_for(between_looks);
        job = take(patiently([&] { return client.get(self); }, server, err), 200, server);
    }
    return job;
}

// An idempotency key: with it the server accepts the request once, however often it is sent.
std::string new_key() {
    std::random_device random;
    std::string key = "submit";
    for (int i = 0; i < 4; ++i) key += fmt::format("-{:08x}", random());
    return key;
}

// Throws the error that `run` would have thrown.
void refuse_failed(const json& job) {
    if (job.at("state") == "succeeded") return;
    if (job.at("state") == "cancelled")
        throw Error(ErrorCode::io, job.at("id").get<std::string>(), "the job was cancelled");
    const json& error = job.at("error");
    if (!error.is_object()) throw Error(ErrorCode::internal, job.at("id").get<std::string>(), "the job failed");
    throw Error(static_cast<ErrorCode>(error.at("code").get<int>()), error.at("where").get<std::string>(),
                error.at("message").get<std::string>());
}

}  // namespace

bool submit_command(const SubmitArguments& arguments, std::ostream& out, std::ostream& err) {
    const std::string body = request_body(arguments), server = without_slash(arguments.server);
    Client client(server, arguments.token_file.empty() ? "" : read_token(arguments.token_file), arguments.cacert);
    const std::string key = new_key();
    const char* const path = arguments.recommend ? "/v1/recommendations" : "/v1/jobs";
    const auto post = [&] { return client.post_json(path, body, {{"Idempotency-Key", key}}); };
    json job = take(arguments.wait ? patiently(post, server, err) : post(), 202, server);
    const std::string self = job.at("links").at("self");
    if (!arguments.wait) {
        out << fmt::format("{} {}: {}\n", job.at("id").get<std::string>(), job.at("state").get<std::string>(),
                           client.url_of(self));
        return true;
    }
    job = wait_for(client, std::move(job), server, err);
    refuse_failed(job);
    // The table that run prints, or the answer. Jobs of earlier versions have none.
    const Reply table = patiently([&] { return client.get(self + "/artifacts/table.txt"); }, server, err);
    if (table.status == 200) out << table.body;
    out << fmt::format("result: {}/result\n", client.url_of(self));
    return job.at(arguments.recommend ? "reached" : "promises_kept").get<bool>();
}

}  // namespace shadowbench::service
