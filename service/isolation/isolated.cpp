#include "service/isolation/isolated.h"

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "service/isolation/connection.h"
#include "service/isolation/content.h"

namespace shadowbench::service {
namespace {

using base::Error;
using base::ErrorCode;

// Processes of one library. Each has one map at most; one whose map is gone waits for the next.
class HostPool {
public:
    HostPool(std::string file, std::string hash, IsolationOptions options)
        : file_(std::move(file)), hash_(std::move(hash)), options_(std::move(options)) {}

    std::unique_ptr<Connection> take() {
        {
            const std::lock_guard lock(mutex_);
            if (!idle_.empty()) {
                std::unique_ptr<Connection> host = std::move(idle_.back());
                idle_.pop_back();
                return host;
            }
        }
        return std::make_unique<Connection>(options_, file_, hash_);
    }
    void give_back(std::unique_ptr<Connection> host) {
        if (!host || !host->alive()) return;
        const std::lock_guard lock(mutex_);
        idle_.push_back(std::move(host));
    }

private:
    std::string file_, hash_;
    IsolationOptions options_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<Connection>> idle_;
};

// A process for as long as it is needed.
class Borrowed {
public:
    explicit Borrowed(std::shared_ptr<HostPool> pool) : pool_(std::move(pool)), host_(pool_->take()) {}
    ~Borrowed() { pool_->give_back(std::move(host_)); }
    Borrowed(const Borrowed&) = delete;
    Borrowed& operator=(const Borrowed&) = delete;
    Connection* operator->() const { return host_.get(); }

private:
    std::shared_ptr<HostPool> pool_;
    std::unique_ptr<Connection> host_;
};

MessageWriter technique_request(std::size_t index, const techniques::ParameterValues& values,
                                const rays::MapLayout& layout) {
    MessageWriter to;
    to.put(static_cast<std::uint64_t>(index));
    put(to, values);
    to.put(layout);
    return to;
}

class IsolatedMap final : public techniques::MapCalls {
public:
    IsolatedMap(const std::shared_ptr<HostPool>& pool, const MessageWriter& request) : host_(pool) {
        host_->ask(Request::create, "create", request);
    }
    ~IsolatedMap() override {
        if (!host_->alive()) return;
        try {
            host_->ask(Request::destroy, "destroy", {});
        } catch (const Error&) {  // the process is gone, and the map with it
        }
    }

    void add(const rays::LightRays& tile) override {
        MessageWriter to;
        put(to, tile);
        host_->ask(Request::add, "add", to);
    }
    void finish() override { host_->ask(Request::finish, "finish", {}); }
    void lookup(std::span<const techniques::Query> queries, std::span<const techniques::Footprint> footprints,
                std::span<float> visibility) const override {
        MessageWriter to;
        to.put_list(queries);
        to.put_list(footprints);
        to.put_list(std::span<const float>(visibility));  // what stays unanswered stays as it is
        MessageReader from = host_->ask(Request::lookup, "lookup", to);
        std::vector<float> answers;
        from.get_list(answers);
        if (answers.size() != visibility.size())
            throw Error(ErrorCode::internal, "",
                        fmt::format("lookup() of {} queries gave {} answers", visibility.size(), answers.size()));
        std::copy(answers.begin(), answers.end(), visibility.begin());
    }
    void touched(const techniques::Query&, const techniques::Footprint*, std::vector<const void*>&) const override {}
    Bytes bytes() const override { return host_->ask(Request::bytes, "bytes", {}).get<Bytes>(); }
    techniques::NodeStats nodes() const override {
        MessageReader from = host_->ask(Request::nodes, "nodes", {});
        return get_nodes(from);
    }
    void stored(int x, int y, std::span<const float> depths, curves::Curve& out) const override {
        MessageWriter to;
        to.put(x);
        to.put(y);
        to.put_list(depths);
        host_->ask(Request::stored, "stored", to).get_list(out);
    }

private:
    Borrowed host_;
};

class IsolatedTechnique final : public techniques::TechniqueCalls {
public:
    IsolatedTechnique(std::shared_ptr<HostPool> pool, std::size_t index) : pool_(std::move(pool)), index_(index) {}

    std::unique_ptr<techniques::MapCalls> create(const techniques::ParameterValues& values,
                                                 const rays::MapLayout& layout) override {
        return std::make_unique<IsolatedMap>(pool_, technique_request(index_, values, layout));
    }
    double error_bound(const techniques::ParameterValues& values, const rays::MapLayout& layout) override {
        const Borrowed host(pool_);
        return host->ask(Request::error_bound, "error_bound", technique_request(index_, values, layout)).get<double>();
    }
    std::uint64_t least_bytes(const techniques::ParameterValues& values, const rays::MapLayout& layout) override {
        const Borrowed host(pool_);
        return host->ask(Request::least_bytes, "least_bytes", technique_request(index_, values, layout))
            .get<std::uint64_t>();
    }

private:
    std::shared_ptr<HostPool> pool_;
    std::size_t index_;  // in the library
};

}  // namespace

techniques::OpenLibrary open_isolated(const std::filesystem::path& file, const IsolationOptions& options) {
    techniques::OpenLibrary open{techniques::identify(file), {}};
    open.library.isolated = true;
    const auto pool = std::make_shared<HostPool>(std::filesystem::absolute(file).string(), open.library.hash, options);
    const Borrowed host(pool);
    MessageReader from = host->ask(Request::describe, "shadowbench_techniques", {});
    const std::size_t count = from.get_count();
    for (std::size_t i = 0; i < count; ++i) {
        techniques::Description description = get_description(from);
        techniques::check_description(description, file.string());
        open.techniques.push_back({std::move(description), std::make_shared<IsolatedTechnique>(pool, i)});
    }
    return open;
}

}  // namespace shadowbench::service
