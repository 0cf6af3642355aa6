// web/http/door.h -- a door answers the requests below one path. Doors chooses the door for a
// request.
//
// Threads   The server calls a door from many threads at once.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "web/http/answer.h"
#include "web/http/request.h"
#include "web/http/work_queue.h"

namespace stormcellar::web {

class Door {
  public:
    virtual ~Door() = default;
    // Returns the answer if that takes well under a millisecond, because it is kept in memory or
    // only a file must be opened. The thread that serves all connections calls this function. If it
    // returns none, a worker makes the answer: with answer_soon() if long_workers() is set, else
    // with answer().
    virtual std::optional<Answer> answer_at_once(const Request& /*request*/) {
        return std::nullopt;
    }
    // Makes the answer, however long it takes. If it throws, the client gets 503.
    virtual Answer answer(const Request& request) = 0;
    // Returns the answer. If computing it takes long, returns none, and a worker of long_workers()
    // then calls answer(). The server calls answer_soon() only if long_workers() is set.
    virtual std::optional<Answer> answer_soon(const Request& request) { return answer(request); }

    // Gives the door workers of its own, so that other doors need not wait for its slow answers.
    // Several doors may share these workers. Requests beyond their capacity get 503. A door without
    // workers of its own uses the server's workers. Call this before the server opens.
    void set_workers(std::shared_ptr<WorkQueue> workers) { workers_ = std::move(workers); }
    [[nodiscard]] const std::shared_ptr<WorkQueue>& workers() const { return workers_; }
    // Gives the door workers that make the answers for which answer_soon() returns none. Without
    // them, the server does not call answer_soon(). Call this before the server opens.
    void set_long_workers(std::shared_ptr<WorkQueue> workers) {
        long_workers_ = std::move(workers);
    }
    [[nodiscard]] const std::shared_ptr<WorkQueue>& long_workers() const { return long_workers_; }

  private:
    std::shared_ptr<WorkQueue> workers_, long_workers_;
};

// Finds the door with the longest matching prefix of whole segments: "/s3" matches "/s3", "/s3/"
// and "/s3/a", but not "/s3a". "/" matches everything.
class Doors {
  public:
    void add(std::string prefix, std::shared_ptr<Door> door);
    // Returns the door for a path. Returns null if no prefix matches, which cannot happen if there
    // is a door "/".
    [[nodiscard]] std::shared_ptr<Door> find(std::string_view path) const;
    // Returns the prefixes of all doors, the longest first.
    [[nodiscard]] std::vector<std::string> prefixes() const;
    // Returns the workers and long workers of all doors, each once.
    [[nodiscard]] std::vector<std::shared_ptr<WorkQueue>> workers() const;

  private:
    std::vector<std::pair<std::string, std::shared_ptr<Door>>> doors_;
};

}  // namespace stormcellar::web
