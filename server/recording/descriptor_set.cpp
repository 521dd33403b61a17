#include "descriptor_set.h"

#include <set>

#include <google/protobuf/descriptor.pb.h>

namespace spindrift::recording {
namespace {

using google::protobuf::FileDescriptor;

void add(const FileDescriptor& file, std::set<const FileDescriptor*>& known, google::protobuf::FileDescriptorSet& out) {
  if (!known.insert(&file).second) return;
  for (int k = 0; k < file.dependency_count(); ++k) add(*file.dependency(k), known, out);
  file.CopyTo(out.add_file());
}

}  // namespace

core::Bytes descriptorSetOf(const google::protobuf::Descriptor& message) {
  google::protobuf::FileDescriptorSet set;
  std::set<const FileDescriptor*> known;
  add(*message.file(), known, set);
  core::Bytes out(set.ByteSizeLong());
  set.SerializeToArray(out.data(), static_cast<int>(out.size()));
  return out;
}

}  // namespace spindrift::recording
