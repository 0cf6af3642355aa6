// stormcellar/base/interface.h -- the base of interfaces, whose objects are neither copied nor
// moved.
//
// Threads   Has no state.
#pragma once

namespace stormcellar {

class Interface {
  public:
    Interface(const Interface&) = delete;
    Interface& operator=(const Interface&) = delete;
    virtual ~Interface() = default;

  protected:
    Interface() = default;
};

}  // namespace stormcellar
