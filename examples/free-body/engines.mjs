// The engines for JavaScript: one body, asked line by line. node engines.mjs NODE_MODULES
//
// The first line has the engine, the moments, the body rates and the step; each further one has how many rows are wanted
// and how many steps lie between them. The answer has the rows, attitude w, x, y, z and velocity in space, and the seconds
// that the steps took.
import { createRequire } from "node:module";
import { createInterface } from "node:readline";
import { pathToFileURL } from "node:url";

const require = createRequire(process.argv[2] + "/");
const load = async (name) => import(pathToFileURL(require.resolve(name)).href);

const engines = {
  async rapier({ moments: [x, y, z], rates, step }) {
    const module = await load("@dimforge/rapier3d-compat");
    const rapier = module.default ?? module;
    await rapier.init();
    const world = new rapier.World({ x: 0, y: 0, z: 0 });
    world.timestep = step;
    const body = world.createRigidBody(
      rapier.RigidBodyDesc.dynamic()
        .setAdditionalMassProperties(1, { x: 0, y: 0, z: 0 }, { x, y, z }, { x: 0, y: 0, z: 0, w: 1 })
        .setCanSleep(false)
        .setAngvel({ x: rates[0], y: rates[1], z: rates[2] }),
    );
    const read = () => {
      const q = body.rotation(), w = body.angvel();
      return [q.w, q.x, q.y, q.z, w.x, w.y, w.z];
    };
    return { advance: () => world.step(), read };
  },

  async cannon({ moments, rates, step }) {
    const module = await load("cannon-es");
    const world = new module.World();
    world.gravity.set(0, 0, 0);
    const body = new module.Body({ mass: 1, angularDamping: 0, linearDamping: 0 });
    world.addBody(body);
    // An inertia is that of a shape, and there is none.
    body.inertia.set(...moments);
    body.invInertia.set(...moments.map((moment) => 1 / moment));
    body.updateInertiaWorld(true);
    body.angularVelocity.set(...rates);
    const read = () => {
      const q = body.quaternion, w = body.angularVelocity;
      return [q.w, q.x, q.y, q.z, w.x, w.y, w.z];
    };
    return { advance: () => world.step(step), read };
  },

  async jolt({ moments, rates, step }, gyroscopic = false) {
    const module = await load("jolt-physics");
    const jolt = await module.default();
    const settings = new jolt.JoltSettings();
    const pairs = new jolt.ObjectLayerPairFilterTable(1);
    const layers = new jolt.BroadPhaseLayerInterfaceTable(1, 1);
    layers.MapObjectToBroadPhaseLayer(0, new jolt.BroadPhaseLayer(0));
    settings.mObjectLayerPairFilter = pairs;
    settings.mBroadPhaseLayerInterface = layers;
    settings.mObjectVsBroadPhaseLayerFilter = new jolt.ObjectVsBroadPhaseLayerFilterTable(layers, 1, pairs, 1);
    const world = new jolt.JoltInterface(settings);
    world.GetPhysicsSystem().SetGravity(new jolt.Vec3(0, 0, 0));
    const at = new jolt.RVec3(0, 0, 0), turned = new jolt.Quat(0, 0, 0, 1);
    const about = new jolt.BodyCreationSettings(new jolt.SphereShape(0.5), at, turned, jolt.EMotionType_Dynamic, 0);
    // The page of this example says so.
    if (about.mApplyGyroscopicForce) throw new Error("Jolt has the gyroscopic force by default now");
    about.mApplyGyroscopicForce = gyroscopic;
    about.mAngularDamping = about.mLinearDamping = 0;
    about.mAllowSleeping = false;
    // Else the rates are cut at 47 rad/s, which would hide that they grow.
    about.mMaxAngularVelocity = 1e6;
    about.mOverrideMassProperties = jolt.EOverrideMassProperties_MassAndInertiaProvided;
    about.mMassPropertiesOverride.mMass = 1;
    about.mMassPropertiesOverride.mInertia = jolt.Mat44.prototype.sScaleVec3(new jolt.Vec3(...moments));
    const bodies = world.GetPhysicsSystem().GetBodyInterface();
    const body = bodies.CreateBody(about);
    bodies.AddBody(body.GetID(), jolt.EActivation_Activate);
    bodies.SetAngularVelocity(body.GetID(), new jolt.Vec3(...rates));
    const read = () => {
      const q = body.GetRotation(), w = body.GetAngularVelocity();
      return [q.GetW(), q.GetX(), q.GetY(), q.GetZ(), w.GetX(), w.GetY(), w.GetZ()];
    };
    return { advance: () => world.Step(step, 1), read };
  },
};
engines["jolt-gyroscopic"] = (about) => engines.jolt(about, true);

let body;
for await (const line of createInterface({ input: process.stdin })) {
  const question = JSON.parse(line);
  if (question.engine) {
    body = await engines[question.engine](question);
    console.log("{}");
    continue;
  }
  const rows = [];
  const begun = performance.now();
  for (let row = 0; row < question.count; row += 1) {
    for (let step = 0; step < question.every; step += 1) body.advance();
    rows.push(body.read());
  }
  console.log(JSON.stringify({ seconds: (performance.now() - begun) / 1000, rows }));
}
