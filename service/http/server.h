// The HTTP front: sockets around a Service.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "service/api/service.h"
#include "service/http/channel.h"

namespace shadowbench::service {

struct HttpOptions {
    std::string host = "127.0.0.1";
    int port = 0;               // 0: any that is free
    std::string token;          // empty: none; only on loopback
    std::size_t workers = 32;   // threads, beside one for each client that may follow events
    std::size_t waiting = 512;  // connections that may wait for a thread; more are told 503
    ChannelLimits channel;
};

class HttpServer {
public:
    // Binds: from here on clients can connect. `streams` is ServiceOptions::event_streams. Throws Error{usage} for an
    // address beyond this machine without a token, Error{io} when it cannot bind.
    HttpServer(Service& service, std::size_t streams, HttpOptions options);
    ~HttpServer();
    HttpServer(const HttpServer&) = delete;
    HttpServer& operator=(const HttpServer&) = delete;

    int port() const;
    std::string url() const;

    // Answers until stop(), then lets the answers in work end.
    void run();
    // From any thread, also before run(). Clients that follow events go when their Jobs stops.
    void stop();

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace shadowbench::service
