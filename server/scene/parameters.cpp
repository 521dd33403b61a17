#include <algorithm>
#include <utility>

#include <google/protobuf/descriptor.h>

#include <spindrift/core/text.h>
#include <spindrift/scene/fields.h>
#include <spindrift/scene/parameters.h>
#include <spindrift/scene/scene_rules.h>

namespace spindrift::scene {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// Maximum length of an unknown path in error messages; longer than any real path.
constexpr std::size_t kPathEchoMaxBytes = 64;

v1::ParameterDescription describe(const v1::ParameterOptions& options, const std::string& path, double value) {
  v1::ParameterDescription out;
  out.set_path(path);
  out.set_label(options.label());
  out.set_unit(options.unit());
  out.set_min(options.min());
  out.set_max(options.max());
  out.set_step(options.step());
  out.set_default_(options.default_());
  out.set_value(value);
  out.set_help(options.help());
  return out;
}

/// Calls `visit` for each parameter that changes while a room runs.
void forEachLive(const v1::Scene& scene, const FieldVisitor& visit) {
  forEachField(scene, "", [&](const Message& part, const FieldDescriptor& field, const std::string& path) {
    const v1::ParameterOptions* options = parameterOptions(field);
    const bool is_of_list = path.find('[') != std::string::npos;
    if (options && !options->restart() && !is_of_list) visit(part, field, path);
  });
}

/// Target of a path: the part with the field (null if the scene lacks the part), and the field.
struct FieldTarget {
  const Message* part = nullptr;
  const FieldDescriptor* field = nullptr;
  std::string absent_part;
};

/// Returns nullopt if no scene has a parameter with this path.
std::optional<FieldTarget> findTarget(const v1::Scene& scene, std::string_view path) {
  FieldTarget target{&scene, nullptr, {}};
  const Descriptor* type = v1::Scene::GetDescriptor();
  for (std::string_view rest = path;;) {
    const std::size_t dot = rest.find('.');
    const FieldDescriptor* field = type->FindFieldByName(std::string(rest.substr(0, dot)));
    if (field == nullptr || field->is_repeated()) return std::nullopt;
    if (dot == std::string_view::npos) {
      if (parameterOptions(*field) == nullptr) return std::nullopt;
      target.field = field;
      return target;
    }
    if (field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) return std::nullopt;
    if (target.part != nullptr) {
      const google::protobuf::Reflection& reflection = *target.part->GetReflection();
      if (reflection.HasField(*target.part, field)) {
        target.part = &reflection.GetMessage(*target.part, field);
      } else {
        target.part = nullptr;
        target.absent_part = field->name();
      }
    }
    type = field->message_type();
    rest.remove_prefix(dot + 1);
  }
}

std::optional<FieldIssue> checkTarget(const std::optional<FieldTarget>& target, std::string_view path, double value) {
  const std::string shown = core::cleanText(path, kPathEchoMaxBytes);
  if (!target) {
    return FieldIssue{v1::REJECT_REASON_UNKNOWN_PARAMETER, shown,
                      "no parameter of this name; the greeting lists what can be set"};
  }
  if (target->part == nullptr) {
    return FieldIssue{v1::REJECT_REASON_ABSENT_PART, shown,
                      "this scene has no " + target->absent_part + "; choose a scene that has"};
  }
  const v1::ParameterOptions& options = *parameterOptions(*target->field);
  if (options.restart()) {
    return FieldIssue{v1::REJECT_REASON_NEEDS_RESTART, shown,
                      "fixed while the room runs at " +
                          core::formatQuantity(numberOf(*target->part, *target->field), options.unit()) +
                          "; change it in the scene file and start again"};
  }
  auto issue = checkNumber(*target->field, value);
  if (issue) issue->path = shown;
  return issue;
}

/// Returns why the rest of the scene forbids a value that is within its own range, such as water too shallow for a
/// boat.
std::optional<FieldIssue> checkChanged(const v1::Scene& changed, std::string_view path) {
  if (!changed.has_wave()) return std::nullopt;
  const std::vector<FieldIssue> issues = checkWater(changed);
  if (issues.empty()) return std::nullopt;
  const FieldIssue& issue = issues.front();
  return FieldIssue{issue.reason, std::string(path),
                    issue.path == path ? issue.message : issue.path + ": " + issue.message};
}

/// Returns whether the equations of the scene's water do not have this parameter, or fix it while the room runs.
bool hasNoEffect(const v1::Scene& scene, std::string_view path) {
  if (scene.wave().bulk() == v1::BULK_NONLINEAR) return path == "wave.steepening_ratio" || path == "wave.depth_m";
  return path == "wave.manning_spm13";
}

void appendReference(const Descriptor& type, const std::string& prefix, std::string& table) {
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      appendReference(*field.message_type(), prefix + field.name() + (field.is_repeated() ? "[]." : "."), table);
    } else if (const v1::ParameterOptions* options = parameterOptions(field)) {
      table += "| `" + prefix + field.name() + "` | " + options->label() + " | " + options->unit() + " | " +
               core::formatNumber(options->min()) + " to " + core::formatNumber(options->max());
      if (options->multiple_of() > 0) table += ", multiple of " + core::formatNumber(options->multiple_of());
      table += " | " + core::formatNumber(options->default_()) + " | " + (options->restart() ? "restart" : "live") +
               " | " + options->help() + " |\n";
    }
  }
}

}  // namespace

std::vector<v1::ParameterDescription> describeParameters(const v1::Scene& scene) {
  std::vector<v1::ParameterDescription> out;
  forEachLive(scene, [&](const Message& part, const FieldDescriptor& field, const std::string& path) {
    if (!hasNoEffect(scene, path)) out.push_back(describe(*parameterOptions(field), path, numberOf(part, field)));
  });
  return out;
}

std::vector<v1::ParameterDescription> changedParameters(const v1::Scene& file, const v1::Scene& now) {
  std::vector<v1::ParameterDescription> out = describeParameters(now);
  const std::vector<v1::ParameterDescription> before = describeParameters(file);
  std::erase_if(out, [&](const v1::ParameterDescription& one) {
    const auto same = std::ranges::find(before, one.path(), &v1::ParameterDescription::path);
    return same != before.end() && same->value() == one.value();
  });
  return out;
}

std::optional<FieldIssue> checkParameter(const v1::Scene& scene, std::string_view path, double value) {
  v1::Scene changed = scene;
  return setParameter(changed, path, value);
}

std::optional<FieldIssue> setParameter(v1::Scene& scene, std::string_view path, double value) {
  v1::Scene changed = scene;
  const std::optional<FieldTarget> target = findTarget(changed, path);
  if (auto error = checkTarget(target, path, value)) return error;
  // The part belongs to `changed`, a copy that may be modified.
  setNumber(const_cast<Message&>(*target->part), *target->field, value);
  if (auto error = checkChanged(changed, path)) return error;
  scene = std::move(changed);
  return std::nullopt;
}

void keepParameters(const v1::Scene& from, v1::Scene& to) {
  forEachLive(to, [&](const Message& part, const FieldDescriptor& field, const std::string& path) {
    if (path == "particles.count" || path == "particles.iterations_count") return;  // applyFidelity() sets them
    const Message* known = findTarget(from, path)->part;
    if (known) setNumber(const_cast<Message&>(part), field, numberOf(*known, field));
  });
}

std::string parameterReferenceMarkdown() {
  std::string table =
      "| Parameter | Name | Unit | Range | Default | Change | What changes when it changes |\n"
      "|---|---|---|---|---|---|---|\n";
  appendReference(*v1::Scene::descriptor(), "", table);
  return table;
}

}  // namespace spindrift::scene
