#include "service/api/message.h"

#include <unistd.h>

namespace shadowbench::service {
namespace {

const std::string* first(const std::vector<Field>& fields, const std::string& name) {
    for (const Field& field : fields)
        if (field.name == name) return &field.value;
    return nullptr;
}

}  // namespace

const std::string* ApiRequest::header(const std::string& lower_name) const {
    return first(headers, lower_name);
}

const std::string* ApiRequest::parameter(const std::string& name) const {
    return first(query, name);
}

const std::string* ApiResponse::header(const std::string& name) const {
    return first(headers, name);
}

OpenFile::~OpenFile() {
    ::close(descriptor);
}

}  // namespace shadowbench::service
