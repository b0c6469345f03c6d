#include "base/error.h"

#include <utility>

namespace shadowbench::base {

Error::Error(ErrorCode code, std::string where, std::string message)
    : code_(code), where_(std::move(where)), message_(std::move(message)) {
    line_ = where_.empty() ? message_ : where_ + ": " + message_;
    for (char& c : line_)
        if (c == '\n' || c == '\r') c = ' ';
}

}  // namespace shadowbench::base
