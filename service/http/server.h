// The HTTP server: sockets around a Service.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "service/api/service.h"
#include "service/http/channel.h"
#include "service/http/guard.h"
#include "service/log/log.h"

namespace shadowbench::service {

struct HttpOptions {
    std::string host = "127.0.0.1";
    int port = 0;                          // 0: any free port
    std::vector<AccessToken> tokens = {};  // empty: none; allowed only on loopback
    std::string base_path = {};            // see take_prefix()
    std::size_t workers = 32;   // threads, besides one for each client that may follow events and one for monitors
    std::size_t waiting = 512;  // connections that may wait for a thread; more get 503
    ChannelLimits channel;
    Log log = {};  // gets a line for each request
};

class HttpServer {
public:
    // Binds, so that clients can connect. `streams` is ServiceOptions::event_streams. Throws Error{usage} for an
    // address that other machines can reach without a token, Error{io} when it cannot bind.
    HttpServer(Service& service, std::size_t streams, HttpOptions options);
    ~HttpServer();
    HttpServer(const HttpServer&) = delete;
    HttpServer& operator=(const HttpServer&) = delete;

    int port() const;
    std::string url() const;

    // Answers requests until stop(), and finishes those in work.
    void run();
    // Any thread may call it, also before run(). The streams of events end when their Jobs stops.
    void stop();

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace shadowbench::service
