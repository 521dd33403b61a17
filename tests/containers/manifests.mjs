// Reads the manifests of docker/kubernetes and checks them against the schema of Kubernetes: types and required fields by the
// compiled schema of the npm package kubernetes-models, unknown fields and wrong words by TypeScript on its declarations, which refuses
// properties that a literal must not have. (The compiled schema lets them pass, as the server of Kubernetes does with a warning.)
import { readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

import { parseAllDocuments } from "yaml";

import { repository } from "../tools/workshop.mjs";

const require = createRequire(import.meta.url);
const here = join(repository, "tests/containers");

export function readDocuments(folder) {
  return readdirSync(folder)
    .filter((file) => file.endsWith(".yaml"))
    .flatMap((file) =>
      parseAllDocuments(readFileSync(join(folder, file), "utf8"), { uniqueKeys: true }).map((document) => {
        if (document.errors.length > 0) throw new Error(`${file}: ${document.errors[0].message}`);
        return { file, resource: document.toJS() };
      }),
    );
}

/** The resources of a folder without its kustomizations. */
export const readResources = (folder) => readDocuments(folder).filter(({ resource }) => resource.kind !== "Kustomization");

const moduleOf = (resource) => (resource.apiVersion.includes("/") ? resource.apiVersion : `${resource.apiVersion}`);
const nameOf = ({ file, resource }) => `${file}: ${resource.kind} ${resource.metadata.name}`;

/** What the compiled schema says against the resources, one line each. */
export function schemaFaults(entries) {
  return entries.flatMap((entry) => {
    const model = require(`kubernetes-models/${moduleOf(entry.resource)}`)[entry.resource.kind];
    if (!model) return [`${nameOf(entry)}: Kubernetes has no ${entry.resource.apiVersion} ${entry.resource.kind}`];
    try {
      new model(entry.resource).validate();
      return [];
    } catch (error) {
      return [`${nameOf(entry)}: ${error.message}`];
    }
  });
}

/** What TypeScript says against the resources as literals, one line each. */
export function literalFaults(entries) {
  const typescript = require(join(repository, "web-client/node_modules/typescript"));
  const file = join(here, `manifests_${process.pid}.ts`);
  const lines = entries.flatMap(({ resource }, index) => [
    `import type { I${resource.kind} as Kind${index} } from "kubernetes-models/${moduleOf(resource)}";`,
    `export const resource${index}: Kind${index} = ${JSON.stringify(resource)};`,
  ]);
  writeFileSync(file, `${lines.join("\n")}\n`);
  try {
    const program = typescript.createProgram([file], {
      noEmit: true,
      strict: true,
      skipLibCheck: true,
      types: [],
      module: typescript.ModuleKind.NodeNext,
      moduleResolution: typescript.ModuleResolutionKind.NodeNext,
    });
    return typescript.getPreEmitDiagnostics(program).map((fault) => {
      const line = fault.file ? fault.file.getLineAndCharacterOfPosition(fault.start).line : -1;
      const entry = entries[Math.floor(line / 2)];
      return `${entry ? nameOf(entry) : "manifests"}: ${typescript.flattenDiagnosticMessageText(fault.messageText, " ")}`;
    });
  } finally {
    rmSync(file, { force: true });
  }
}
