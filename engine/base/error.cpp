#include "base/error.h"

#include "base/printable.h"

namespace shadowbench::base {

Error::Error(ErrorCode code, std::string_view where, std::string_view message)
    : code_(code), where_(printable(where)), message_(printable(message)) {
    line_ = where_.empty() ? message_ : where_ + ": " + message_;
}

}  // namespace shadowbench::base
