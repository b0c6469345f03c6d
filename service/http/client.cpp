#include "service/http/client.h"

#include <httplib.h>

#include "base/error.h"

namespace shadowbench::service {
namespace {

using base::Error;
using base::ErrorCode;

Reply reply_of(const httplib::Result& result, const std::string& url) {
    if (!result) throw Error(ErrorCode::io, url, "the server does not answer: " + httplib::to_string(result.error()));
    return {result->status, result->get_header_value("Content-Type"), result->body,
            result->get_header_value("Location")};
}

}  // namespace

struct Client::State {
    httplib::Client client;
};

Client::Client(const std::string& url, const std::string& token) : url_(url) {
    if (!url.starts_with("http://") && !url.starts_with("https://"))
        throw Error(ErrorCode::usage, "--server " + url, "expected a URL of the form http://host:port");
    state_.reset(new State{httplib::Client(url)});
    if (!state_->client.is_valid())
        throw Error(ErrorCode::usage, "--server " + url, "expected a URL of the form http://host:port");
    state_->client.set_connection_timeout(10);
    state_->client.set_read_timeout(120);
    state_->client.set_tcp_nodelay(true);
    if (!token.empty()) state_->client.set_bearer_token_auth(token);
}

Client::~Client() = default;

Reply Client::get(const std::string& path) {
    return reply_of(state_->client.Get(path), url_);
}

Reply Client::post_json(const std::string& path, const std::string& body, const std::vector<Field>& headers) {
    httplib::Headers fields;
    for (const Field& field : headers) fields.emplace(field.name, field.value);
    return reply_of(state_->client.Post(path, fields, body, "application/json"), url_);
}

}  // namespace shadowbench::service
