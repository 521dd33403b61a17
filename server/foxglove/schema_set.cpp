#include <set>

#include <google/protobuf/descriptor.pb.h>

#include <spindrift/foxglove/schema_set.h>

namespace spindrift::foxglove {
namespace {

namespace pb = google::protobuf;

/// Types of files' outermost level, with all that is nested in them, and their files.
struct Needed {
  std::set<const pb::Descriptor*> messages;
  std::set<const pb::EnumDescriptor*> enums;
  std::set<const pb::FileDescriptor*> files;
};

void addFields(const pb::Descriptor& message, Needed& needed);

void add(const pb::Descriptor& message, Needed& needed) {
  const pb::Descriptor* outer = &message;
  while (outer->containing_type()) outer = outer->containing_type();
  if (!needed.messages.insert(outer).second) return;
  needed.files.insert(outer->file());
  addFields(*outer, needed);
}

void addFields(const pb::Descriptor& message, Needed& needed) {
  for (int i = 0; i < message.field_count(); ++i) {
    const pb::FieldDescriptor& field = *message.field(i);
    if (field.message_type()) add(*field.message_type(), needed);
    const pb::EnumDescriptor* type = field.enum_type();
    if (type && type->containing_type()) add(*type->containing_type(), needed);
    if (type && !type->containing_type()) {
      needed.enums.insert(type);
      needed.files.insert(type->file());
    }
  }
  for (int i = 0; i < message.nested_type_count(); ++i) addFields(*message.nested_type(i), needed);
}

void clearOptions(pb::EnumDescriptorProto& type) {
  type.clear_options();
  for (pb::EnumValueDescriptorProto& value : *type.mutable_value()) value.clear_options();
}

void clearOptions(pb::DescriptorProto& message) {
  message.clear_options();
  message.clear_extension();
  for (pb::FieldDescriptorProto& field : *message.mutable_field()) field.clear_options();
  for (pb::DescriptorProto& nested : *message.mutable_nested_type()) clearOptions(nested);
  for (pb::EnumDescriptorProto& nested : *message.mutable_enum_type()) clearOptions(nested);
}

void addFile(const pb::FileDescriptor& file, const Needed& needed, std::set<const pb::FileDescriptor*>& added,
             pb::FileDescriptorSet& out) {
  if (!needed.files.contains(&file) || !added.insert(&file).second) return;
  for (int i = 0; i < file.dependency_count(); ++i) addFile(*file.dependency(i), needed, added, out);
  pb::FileDescriptorProto& described = *out.add_file();
  described.set_name(file.name());
  described.set_package(file.package());
  described.set_syntax("proto3");
  for (int i = 0; i < file.dependency_count(); ++i) {
    if (needed.files.contains(file.dependency(i))) described.add_dependency(file.dependency(i)->name());
  }
  for (int i = 0; i < file.message_type_count(); ++i) {
    if (!needed.messages.contains(file.message_type(i))) continue;
    file.message_type(i)->CopyTo(described.add_message_type());
    clearOptions(*described.mutable_message_type()->rbegin());
  }
  for (int i = 0; i < file.enum_type_count(); ++i) {
    if (!needed.enums.contains(file.enum_type(i))) continue;
    file.enum_type(i)->CopyTo(described.add_enum_type());
    clearOptions(*described.mutable_enum_type()->rbegin());
  }
}

}  // namespace

std::string schemaSetOf(const pb::Descriptor& message) {
  Needed needed;
  add(message, needed);
  pb::FileDescriptorSet out;
  std::set<const pb::FileDescriptor*> added;
  addFile(*message.file(), needed, added, out);
  return out.SerializeAsString();
}

}  // namespace spindrift::foxglove
