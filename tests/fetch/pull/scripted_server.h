// tests/fetch/pull/scripted_server.h -- a server on the loopback that answers as a test says,
// faults included.
#pragma once

#include <atomic>
#include <functional>
#include <list>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace stormcellar::pull {

struct Asked {
    std::string path;  // with its query
    std::string tag;   // of If-None-Match
};

struct Reply {
    enum class Way {
        whole,
        cut,    // the connection ends in the midst of the body
        hangs,  // half of the body, and then nothing more
        endless,
    };
    int status = 200;
    std::string body;
    std::string headers;  // each with its line end
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

  private:
    struct Answering {
        std::atomic<bool> is_done{false};
        std::thread thread;
    };
    void serve();
    void answer(int connection);
    void join_done();

    const std::function<Reply(const Asked&)> answer_;
    int listener_ = -1;
    int port_ = 0;
    std::atomic<bool> stop_{false};
    mutable std::mutex mutex_;  // guards asked_
    std::vector<Asked> asked_;
    std::list<Answering> answering_;
    std::thread thread_;
};

}  // namespace stormcellar::pull
