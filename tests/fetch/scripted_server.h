// tests/fetch/scripted_server.h -- a server on loopback that answers as a test says, with faults.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <list>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "tests/testing/loopback.h"

namespace stormcellar::testing {

struct Asked {
    std::string path;  // with its query
    std::string head;  // the request line and all headers
    std::string body = {};
    // Returns the value of a header; empty if there is none.
    [[nodiscard]] std::string header(std::string_view name) const;
    // Returns a parameter of the query, decoded; empty if there is none.
    [[nodiscard]] std::string parameter(std::string_view name) const;
    // Returns the path without its first slash and query, decoded: the key of an object.
    [[nodiscard]] std::string key() const;
};

struct Reply {
    enum class Way {
        whole,
        cut,    // the connection ends in the middle of the body
        hangs,  // half of the body, and then nothing more
        endless,
    };
    int status = 200;
    std::string body = {};
    std::string headers = {};  // each with its line end
    Way way = Way::whole;
};

class ScriptedServer {
  public:
    explicit ScriptedServer(std::function<Reply(const Asked&)> answer);
    ScriptedServer(const ScriptedServer&) = delete;
    ScriptedServer& operator=(const ScriptedServer&) = delete;
    ~ScriptedServer();

    [[nodiscard]] std::string url() const;
    [[nodiscard]] std::vector<Asked> asked() const;
    void forget_asked();
    [[nodiscard]] std::size_t most_at_once() const { return most_at_once_; }

  private:
    struct Answering {
        std::atomic<bool> is_done{false};
        std::thread thread;
    };
    void serve();
    void answer(int connection);
    void join_done();

    const std::function<Reply(const Asked&)> answer_;
    const Descriptor listener_ = bound_socket();
    std::atomic<bool> stop_{false};
    std::atomic<std::size_t> at_once_{0}, most_at_once_{0};
    mutable std::mutex mutex_;  // guards asked_
    std::vector<Asked> asked_;
    std::list<Answering> answering_;
    std::thread thread_;
};

}  // namespace stormcellar::testing
