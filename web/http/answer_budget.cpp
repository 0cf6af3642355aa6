#include "web/http/answer_budget.h"

#include <algorithm>
#include <set>

namespace stormcellar::web {
namespace {

constexpr std::chrono::seconds given_to_new_for{10};

// Returns the object in memory that a piece keeps alive, with its full size.
AnswerBudget::HeldObject object_of(const Piece& piece) {
    if (const auto* text = std::get_if<Text>(&piece)) return {text->get(), (*text)->size()};
    const auto& slice = std::get<FileSlice>(piece);
    return {slice.file.get(), slice.memory_bytes};
}

}  // namespace

// Returns true if the pieces together are so large that they are counted.
bool AnswerBudget::is_counted(const Pieces& pieces) {
    std::uint64_t sum = 0;
    for (const Piece& piece : pieces)
        sum += object_of(piece).bytes;
    return sum >= least_counted_bytes;
}

AnswerBudget::Objects AnswerBudget::objects_of(const Pieces& pieces) {
    Objects objects;
    for (const Piece& piece : pieces)
        if (const HeldObject held = object_of(piece); held.bytes > 0) objects.push_back(held);
    return objects;
}

std::uint64_t AnswerBudget::Holder::bytes_with(const Objects& objects) const {
    std::uint64_t sum = bytes;
    std::set<const void*> fresh;
    for (const HeldObject& held : objects)
        if (!uses.contains(held.object) && fresh.insert(held.object).second) sum += held.bytes;
    return sum;
}

void AnswerBudget::Holder::add(const Objects& objects) {
    for (const HeldObject& held : objects)
        if (++uses[held.object] == 1) bytes += held.bytes;
}

void AnswerBudget::Holder::remove(const Objects& objects) {
    for (const HeldObject& held : objects) {
        const auto use = uses.find(held.object);
        if (use == uses.end() || --use->second > 0) continue;
        uses.erase(use);
        bytes -= held.bytes;
    }
}

bool AnswerBudget::Holder::has_room(const Objects& objects, std::uint64_t most) const {
    const std::uint64_t with = bytes_with(objects);
    return with <= most || with == bytes || bytes == 0;
}

bool AnswerBudget::take(const std::string& client, const Pieces& pieces) {
    if (!is_counted(pieces)) return true;
    const Objects objects = objects_of(pieces);
    const MutexLock lock(mutex_);
    const auto theirs = by_client_.try_emplace(client).first;
    const std::uint64_t of_others = all_.bytes - theirs->second.bytes;
    const std::uint64_t most_of_client = (most_bytes_ - std::min(most_bytes_, of_others)) / 2;
    const SteadyTime now = steady_now();
    const bool is_short = !all_.has_room(objects, most_bytes_);
    if (is_short) given_to_new_until_ = now + given_to_new_for;
    const bool has_room = !is_short && theirs->second.has_room(objects, most_of_client) &&
                          (now >= given_to_new_until_ || theirs->second.bytes == 0);
    if (has_room) {
        all_.add(objects);
        theirs->second.add(objects);
    } else if (theirs->second.uses.empty()) {
        by_client_.erase(theirs);
    }
    return has_room;
}

void AnswerBudget::give_back(const std::string& client, const Pieces& pieces) {
    if (!is_counted(pieces)) return;
    const Objects objects = objects_of(pieces);
    const MutexLock lock(mutex_);
    const auto found = by_client_.find(client);
    if (found == by_client_.end()) return;
    all_.remove(objects);
    found->second.remove(objects);
    if (found->second.uses.empty()) by_client_.erase(found);
}

std::uint64_t AnswerBudget::bytes() const {
    const MutexLock lock(mutex_);
    return all_.bytes;
}

}  // namespace stormcellar::web
