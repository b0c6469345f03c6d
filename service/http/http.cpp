// The server and the client on top of cpp-httplib (0.11.4), which frames answers and reads bodies of a known length.
// head.h parses the heads of requests; httplib gets a safe one instead: see canonical_head(). chunks.h reads chunked
// bodies.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>

#include <sys/socket.h>
#include <unistd.h>

#include <fmt/format.h>
#include <httplib.h>

#include "base/error.h"
#include "service/api/problem.h"
#include "service/http/chunks.h"
#include "service/http/client.h"
#include "service/http/client_fault.h"
#include "service/http/exchange.h"
#include "service/http/guard.h"
#include "service/http/head.h"
#include "service/http/lobby.h"
#include "service/http/prefix.h"
#include "service/http/reception.h"
#include "service/http/server.h"

namespace shadowbench::service {
namespace {

using base::Error;
using base::ErrorCode;

constexpr std::size_t piece_size = 64 * 1024;
constexpr int monitor_answer = 256 * 1024;  // bytes that a socket takes without waiting
constexpr double monitor_seconds = 1.0;     // as ChannelLimits::write_seconds

// The request that httplib works on in this thread. Its handlers take no further argument.
thread_local Exchange* current = nullptr;

// Gives httplib the canonical head, then the body from the channel.
class Wire final : public httplib::Stream {
public:
    Wire(Channel& channel, std::string head) : channel_(channel), head_(std::move(head)) {}

    bool is_readable() const override { return true; }
    bool is_writable() const override { return true; }
    ssize_t read(char* to, size_t size) override {
        if (given_ == head_.size()) return channel_.read(to, size);
        size = std::min(size, head_.size() - given_);
        std::copy_n(head_.data() + given_, size, to);
        given_ += size;
        return static_cast<ssize_t>(size);
    }
    ssize_t write(const char* bytes, size_t size) override {
        return channel_.write(bytes, size) ? static_cast<ssize_t>(size) : -1;
    }
    void get_remote_ip_and_port(std::string&, int&) const override {}
    void get_local_ip_and_port(std::string&, int&) const override {}
    socket_t socket() const override { return 0; }

private:
    Channel& channel_;
    std::string head_;
    std::size_t given_ = 0;
};

// httplib gives this every connection, as a task that calls process_and_close_socket(): that hands it to the lobby, so
// the accepting thread runs the task itself.
class Door final : public httplib::TaskQueue {
public:
    Door(std::size_t threads, std::size_t most, std::atomic<std::size_t>& waiting, Lobby::Serve serve,
         Lobby::Serve serve_monitor)
        : lobby_(threads, most, waiting, std::move(serve), std::move(serve_monitor)) {}

    void enqueue(std::function<void()> task) override { task(); }
    void shutdown() override { lobby_.stop(); }
    Lobby& lobby() { return lobby_; }

private:
    Lobby lobby_;
};

void put_file(const FilePart& part, const std::string& type, httplib::Response& to) {
    const auto provider = [part](size_t offset, size_t length, httplib::DataSink& sink) {
        char piece[piece_size];
        const ssize_t n = ::pread(part.file->descriptor, piece, std::min(length, sizeof piece),
                                  static_cast<off_t>(part.offset + offset));
        return n > 0 && sink.write(piece, static_cast<std::size_t>(n));
    };
    if (part.length > 0)
        to.set_content_provider(part.length, type, provider);
    else
        to.set_header("Content-Type", type);
}

void put_events(const EventSource& events, const std::string& type, Exchange& exchange, httplib::Response& to) {
    const auto provider = [events, &channel = exchange.channel](size_t, httplib::DataSink& sink) {
        if (channel.gone()) return false;
        const std::optional<std::string> text = events();
        if (!text) {
            sink.done();
            return true;
        }
        return text->empty() || sink.write(text->data(), text->size());
    };
    exchange.keep = false;
    if (exchange.head.http10)
        to.set_content_provider(type, provider);
    else
        to.set_chunked_content_provider(type, provider);
}

void put(ApiResponse from, Exchange& exchange, httplib::Response& to) {
    dress(from, exchange);
    to.status = from.status;
    for (const Field& field : from.headers) to.set_header(field.name, field.value);
    if (from.events)
        put_events(from.events, from.type, exchange, to);
    else if (from.file)
        put_file(*from.file, from.type, to);
    else if (!from.type.empty())
        to.set_content(from.body, from.type);
}

// Removes header fields that httplib adds wrongly.
void tidy(httplib::Response& response) {
    response.headers.erase("Keep-Alive");
    if (response.status == 204 || response.status == 304) response.headers.erase("Content-Length");
}

class Front final : public httplib::Server {
public:
    Front(Service& service, std::size_t streams, const HttpOptions& options)
        : service_(service), options_(options), reception_(service_, options_, waiting_) {
        new_task_queue = [this, threads = options.workers + streams, most = options.waiting] {
            return door_ = new Door(
                       threads, most, waiting_, [this](int socket) { serve(socket); },
                       [this](int socket) { serve_monitor(socket); });
        };
        Get("/", [this](const httplib::Request&, httplib::Response& response) { respond(response); });
        Delete("/", [this](const httplib::Request&, httplib::Response& response) { respond(response); });
        Post("/", [this](const httplib::Request&, httplib::Response& response, const httplib::ContentReader& body) {
            read_and_respond(body, response);
        });
        set_post_routing_handler([](const httplib::Request&, httplib::Response& response) { tidy(response); });
        set_exception_handler([](const httplib::Request&, httplib::Response& response, std::exception_ptr) {
            put(problem(500, "Internal fault of the server."), *current, response);
        });
        // Not SO_REUSEPORT: with it another process could listen on the same port.
        set_socket_options([](socket_t socket) {
            const int yes = 1;
            ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
        });
        set_tcp_nodelay(true);
        set_payload_max_length(service.limits().body);
    }

    int bind() {
        const int port = options_.port == 0                           ? bind_to_any_port(options_.host)
                         : bind_to_port(options_.host, options_.port) ? options_.port
                                                                      : -1;
        // httplib's queue of 5 connections would overflow when many clients connect at once.
        if (port > 0) ::listen(svr_sock_, 1024);
        return port;
    }

    // Server::stop() has no effect before the loop begins. A socket that is shut down ends the loop whenever it begins.
    void shut_down() {
        stopping_ = true;
        ::shutdown(svr_sock_, SHUT_RDWR);
    }

    bool stopping() const { return stopping_; }

private:
    bool process_and_close_socket(socket_t socket) override {
        const int yes = 1;
        ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
        if (door_->lobby().add(socket)) return true;
        Channel channel(socket, options_.channel, stopping_, [] { return true; });
        Exchange exchange(channel);
        exchange.refusal = problem(503, "Too many clients; try again later.");
        exchange.refusal->headers.push_back({"Retry-After", "5"});
        pass_on(exchange);
        return true;
    }

    void serve(int socket) {
        Channel channel(socket, options_.channel, stopping_, [this] { return waiting_ > 0; });
        while (!stopping_ && converse(channel, false)) {
        }
    }

    // The head of the request is there, no body is read, and the socket takes the whole answer at once. So nothing
    // waits for the client, even if it reads nothing.
    void serve_monitor(int socket) {
        ::setsockopt(socket, SOL_SOCKET, SO_SNDBUF, &monitor_answer, sizeof monitor_answer);
        ChannelLimits limits = options_.channel;
        limits.write_seconds = std::min(limits.write_seconds, monitor_seconds);
        Channel channel(socket, limits, stopping_, [] { return true; });
        converse(channel, true);
    }

    // Answers one request. Returns whether another may follow on the connection. `at_once`: closes the connection, and
    // does not wait until the client has read the answer.
    bool converse(Channel& channel, bool at_once) {
        Exchange exchange(channel);
        exchange.at_once = at_once;
        if (!reception_.receive(exchange)) return false;
        pass_on(exchange);
        if (!exchange.keep && !at_once) channel.linger();
        return exchange.keep;
    }

    void pass_on(Exchange& exchange) {
        exchange.head.request.id = request_id(exchange.head.request);
        Wire wire(exchange.channel, canonical_head(exchange));
        current = &exchange;
        bool closed = false;
        const bool processed = process_request(wire, !exchange.keep, closed, nullptr);
        current = nullptr;
        exchange.keep = exchange.keep && processed && !closed;
        say(options_.log, access_event(exchange));
    }

    void respond(httplib::Response& response) {
        Exchange& exchange = *current;
        put(exchange.refusal ? std::move(*exchange.refusal) : service_.handle(exchange.head.request), exchange,
            response);
        if (!exchange.keep) response.set_header("Connection", "close");
    }

    // httplib takes sizes of chunks that are none, and does not limit chunked bodies.
    static bool read_body(const httplib::ContentReader& body, Exchange& exchange,
                          const httplib::ContentReceiver& take) {
        if (!exchange.head.request.has_body) return true;
        if (!exchange.head.chunked) return body(take);
        return read_chunks([&](char* to, std::size_t size) { return exchange.channel.read(to, size); }, take);
    }

    void read_and_respond(const httplib::ContentReader& body, httplib::Response& response) {
        Exchange& exchange = *current;
        std::string& bytes = exchange.head.request.body;
        bool too_long = false;
        const bool complete = read_body(body, exchange, [&](const char* piece, size_t size) {
            too_long = bytes.size() + size > service_.limits().body;
            if (!too_long) bytes.append(piece, size);
            return !too_long;
        });
        if (!complete) {
            exchange.keep = false;
            exchange.refusal =
                too_long ? reception_.too_large() : problem(400, "The body is malformed, or took too long to arrive.");
            service_.count_refusal(exchange.head.request, exchange.refusal->status);
        }
        respond(response);
    }

    Service& service_;
    const HttpOptions options_;
    std::atomic<bool> stopping_ = false;
    std::atomic<std::size_t> waiting_ = 0;
    const Reception reception_;
    Door* door_ = nullptr;  // httplib owns it, as long as it listens
};

}  // namespace

struct HttpServer::State {
    Front front;
    std::string host;
    int port = 0;
    std::mutex mutex;
    bool ended = false;  // the listening socket is closed
};

HttpServer::HttpServer(Service& service, std::size_t streams, HttpOptions options) {
    if (options.tokens.empty() && !is_loopback(options.host))
        throw Error(
            ErrorCode::usage, "--host " + options.host,
            "other machines can reach this address; give --token-file FILE, so that not everybody can use the server");
    state_.reset(new State{Front(service, streams, options), options.host, 0, {}, false});
    state_->port = state_->front.bind();
    if (state_->port <= 0)
        throw Error(ErrorCode::io, fmt::format("{}:{}", options.host, options.port),
                    "cannot listen on this address; it may be in use");
}

HttpServer::~HttpServer() = default;

int HttpServer::port() const {
    return state_->port;
}

std::string HttpServer::url() const {
    const bool ipv6 = state_->host.find(':') != std::string::npos;
    return fmt::format("http://{}:{}", ipv6 ? "[" + state_->host + "]" : state_->host, state_->port);
}

void HttpServer::run() {
    state_->front.listen_after_bind();
    const std::scoped_lock lock(state_->mutex);
    state_->ended = true;
}

void HttpServer::stop() {
    const std::scoped_lock lock(state_->mutex);
    if (!state_->ended && !state_->front.stopping()) state_->front.shut_down();
}

namespace {

// host of "http://host", "https://host:port" and "http://[::1]:port".
std::string host_of(const std::string& origin) {
    const std::string authority = origin.substr(origin.find("://") + 3);
    if (authority.starts_with('[')) return authority.substr(1, authority.find(']') - 1);
    return authority.substr(0, authority.find(':'));
}

std::string silence_text(httplib::Error error) {
    switch (error) {
        case httplib::Error::Connection: return "no connection could be made";
        case httplib::Error::SSLConnection: return "no secure connection could be made";
        case httplib::Error::Read: return "no answer came over the connection";
        case httplib::Error::Write: return "the connection ended while the request was sent";
        default: return "the connection failed (" + httplib::to_string(error) + ")";
    }
}

}  // namespace

struct Client::State {
    httplib::Client client;
    std::string host, certificates;

    // What no other try would mend, with its remedy.
    std::optional<std::string> lasting_fault(httplib::Error error) const {
        switch (error) {
            case httplib::Error::Connection:
                if (is_unknown_host(host)) return fmt::format("there is no host {}; check the name in the URL", host);
                return std::nullopt;
            case httplib::Error::SSLConnection:
                if (const auto why = tls_fault())
                    return fmt::format("no TLS connection: {}; check the scheme and the port in the URL", *why);
                return std::nullopt;
            case httplib::Error::SSLLoadingCerts:
                return fmt::format("{} has no certificates in PEM format; give --cacert such a file", certificates);
            case httplib::Error::SSLServerVerification:
                return certificate_fault(client.get_openssl_verify_result(), host);
            default:
                return std::nullopt;
        }
    }

    Reply reply_to(const std::string& url, const std::function<httplib::Result()>& send) const {
        forget_tls_faults();
        const httplib::Result result = send();
        if (result)
            return {result->status, result->get_header_value("Content-Type"), result->body,
                    result->get_header_value("Location")};
        if (const auto fault = lasting_fault(result.error())) throw Error(ErrorCode::usage, url, *fault);
        throw Error(ErrorCode::io, url, "the server does not answer: " + silence_text(result.error()));
    }
};

Client::Client(const std::string& url, const std::string& token, const std::string& certificates) : url_(url) {
    const std::size_t scheme = url.find("://");
    const std::size_t path = scheme == std::string::npos ? url.size() : std::min(url.find('/', scheme + 3), url.size());
    const std::string origin = url.substr(0, path);
    base_ = url.substr(path);
    if (url.starts_with("http://") || url.starts_with("https://"))
        state_.reset(new State{httplib::Client(origin), host_of(origin), certificates});
    if (!state_ || !state_->client.is_valid() || (!base_.empty() && !is_prefix(base_)))
        throw Error(ErrorCode::usage, "--server " + url, "expected a URL of the form http://host:port/path");
    if (!certificates.empty()) state_->client.set_ca_cert_path(certificates.c_str());
    state_->client.enable_server_certificate_verification(true);
    state_->client.set_connection_timeout(10);
    state_->client.set_read_timeout(120);
    state_->client.set_tcp_nodelay(true);
    if (!token.empty()) state_->client.set_bearer_token_auth(token);
}

Client::~Client() = default;

// Links of the server's answers have the path of its URL already, where a proxy says what that is.
std::string Client::place_of(const std::string& path) const {
    return path.starts_with(base_ + "/v1/") ? path : base_ + path;
}

std::string Client::url_of(const std::string& path) const {
    return url_.substr(0, url_.size() - base_.size()) + place_of(path);
}

Reply Client::get(const std::string& path) {
    return state_->reply_to(url_, [&] { return state_->client.Get(place_of(path)); });
}

Reply Client::post_json(const std::string& path, const std::string& body, const std::vector<Field>& headers) {
    httplib::Headers fields;
    for (const Field& field : headers) fields.emplace(field.name, field.value);
    return state_->reply_to(url_,
                            [&] { return state_->client.Post(place_of(path), fields, body, "application/json"); });
}

}  // namespace shadowbench::service
