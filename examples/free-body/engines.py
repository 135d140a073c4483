"""One body in each engine, behind one interface: moments of inertia, body rates and a step; advance; read.

An engine is imported where its body is made, so that one that isn't there is missed by nobody else. What an engine has by
default stays as it is, but for damping, gravity and sleep, which are off: with them there is no free body.
"""

import importlib
import importlib.metadata
import json
import pathlib
import subprocess
import time

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent


def matrix(q):
    """The rotation of a quaternion `w, x, y, z` of any length."""
    w, x, y, z = np.asarray(q, float) / np.linalg.norm(q)
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])


class Engine:
    """A body with principal moments, kg m², that starts at the identity with body rates, rad/s.

    `step` is the step that is really made, s: some engines round it. `read` gives the attitude as a quaternion
    `w, x, y, z`, body to space, and the body rates.
    """

    title = ""
    package = ""  # whose version is recorded
    setting = ""
    digits = "double"
    usual = None  # the step that the engine has by default, s, and nothing where it has none
    color = "#777777"
    adaptive = False  # whether `step` is only how often it is read

    def __init__(self, moments, rates, step):
        self.moments, self.rates, self.step = np.array(moments, float), np.array(rates, float), float(step)
        self.make()

    def make(self):
        raise NotImplementedError

    def advance(self, steps):
        raise NotImplementedError

    def read(self):
        raise NotImplementedError

    def record(self, count, every, end):
        """Up to `count` rows of quaternion and rates, `every` steps apart; it ends where the clock is at `end`."""
        rows = []
        for _ in range(count):
            self.advance(every)
            rows.append(np.concatenate(self.read()))
            if time.monotonic() > end:
                break
        return np.array(rows)

    def seconds(self, steps):
        """The seconds that so many steps take."""
        begun = time.perf_counter()
        self.advance(steps)
        return time.perf_counter() - begun

    def close(self):
        pass

    @classmethod
    def version(cls):
        return importlib.metadata.version(cls.package)


class Ours(Engine):
    title, package, setting, color = "liestep (3.13)", "liestep", "`ls.body(J).stepper(h)`", "#d62728"
    method = {}

    def make(self):
        import liestep as ls

        self.stepper = ls.body(self.moments).stepper(self.step, **self.method)

    def run(self, steps, every):
        return self.stepper.run(velocity=self.rates, until=steps * self.step, every=every)

    def advance(self, steps):
        self.run(steps, steps)

    def record(self, count, every, end):
        # A run can't be gone on with to the bit from Python, so that its length is chosen before.
        probe = min(count * every, 200_000)
        took = max(self.seconds(probe), 1e-6)
        fits = int((end - time.monotonic()) * 0.8 * probe / took / every)
        run = self.run(max(min(count, fits), 1) * every, every)
        return np.concatenate([run.quaternion, run.velocity], axis=1)[1:]


class OursExact(Ours):
    title, setting, color = "liestep, exact", "`splitting=\"Strang\"`: `ExactBody`, and nothing that kicks it", "#ff9896"
    method = {"splitting": "Strang"}


class Mujoco(Engine):
    package, usual, integrator = "mujoco", 0.002, "Euler"
    title, setting, color = "MuJoCo Euler", "`integrator=\"Euler\"`, the default", "#1f77b4"

    def make(self):
        import mujoco

        self.step_by = mujoco.mj_step
        inertia = " ".join(map(repr, map(float, self.moments)))
        self.model = mujoco.MjModel.from_xml_string(
            f'<mujoco><option timestep="{self.step!r}" gravity="0 0 0" integrator="{self.integrator}"/><worldbody><body>'
            f'<freejoint/><inertial pos="0 0 0" mass="1" diaginertia="{inertia}"/></body></worldbody></mujoco>')
        # The compiler may put the axes into another order, of which `read` knows nothing.
        if not np.array_equal(self.model.body_inertia[1], self.moments):
            raise RuntimeError("MuJoCo has changed the axes of the body")
        self.data = mujoco.MjData(self.model)
        self.data.qvel[3:] = self.rates

    def advance(self, steps):
        self.step_by(self.model, self.data, nstep=steps)

    def read(self):
        return self.data.qpos[3:].copy(), self.data.qvel[3:].copy()


class MujocoImplicit(Mujoco):
    title, setting, color, integrator = "MuJoCo implicitfast", "`integrator=\"implicitfast\"`", "#6baed6", "implicitfast"


class MujocoRunge(Mujoco):
    title, setting, color, integrator = "MuJoCo RK4", "`integrator=\"RK4\"`", "#08306b", "RK4"


class Bullet(Engine):
    title, package, usual, color = "PyBullet, multibody", "pybullet", 1 / 240, "#2ca02c"
    setting, maximal = "`createMultiBody`", False

    def make(self):
        import pybullet

        self.p = pybullet
        pybullet.connect(pybullet.DIRECT)
        pybullet.setTimeStep(self.step)
        shape = pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=0.1)
        self.body = pybullet.createMultiBody(1, shape, useMaximalCoordinates=self.maximal)
        pybullet.changeDynamics(self.body, -1, mass=1, localInertiaDiagonal=list(self.moments), linearDamping=0,
                                angularDamping=0, activationState=pybullet.ACTIVATION_STATE_DISABLE_SLEEPING)
        pybullet.resetBaseVelocity(self.body, angularVelocity=list(self.rates))

    def advance(self, steps):
        step = self.p.stepSimulation
        for _ in range(steps):
            step()

    def read(self):
        x, y, z, w = self.p.getBasePositionAndOrientation(self.body)[1]
        q = np.array([w, x, y, z])
        return q, matrix(q).T @ self.p.getBaseVelocity(self.body)[1]

    def close(self):
        self.p.disconnect()


class BulletRigid(Bullet):
    title, setting, color, maximal = "PyBullet, rigid body", "`useMaximalCoordinates=True`", "#98df8a", True


class Drake(Engine):
    title, package, usual, color = "Drake, discrete", "drake", 0.001, "#9467bd"
    setting, plant_step = "`MultibodyPlant(h)`", True

    def make(self):
        from pydrake.multibody.plant import MultibodyPlant
        from pydrake.multibody.tree import SpatialInertia, UnitInertia
        from pydrake.systems.analysis import Simulator

        self.plant = MultibodyPlant(self.step if self.plant_step else 0.0)
        self.plant.AddRigidBody("body", SpatialInertia(1.0, np.zeros(3), UnitInertia(*self.moments)))
        self.plant.mutable_gravity_field().set_gravity_vector([0, 0, 0])
        self.plant.Finalize()
        self.simulator = Simulator(self.plant)
        self.context, self.made = self.simulator.get_mutable_context(), 0
        self.plant.SetVelocities(self.context, np.concatenate([self.rates, np.zeros(3)]))
        self.simulator.Initialize()

    def advance(self, steps):
        self.made += steps
        # An update of the time t is made when the time leaves t, so that the middle of a step has those before it.
        self.simulator.AdvanceTo((self.made - (0.5 if self.plant_step else 0)) * self.step)

    def read(self):
        q = self.plant.GetPositions(self.context)[:4]
        return q, matrix(q).T @ self.plant.GetVelocities(self.context)[:3]


class DrakeContinuous(Drake):
    title, color, plant_step, adaptive = "Drake, continuous", "#c5b0d5", False, True
    setting, usual = "`MultibodyPlant(0)`: Runge–Kutta 3 with its error control", None


class Pinocchio(Engine):
    title, package, color = "Pinocchio", "pin", "#8c564b"
    setting = "`aba`, then `integrate` with the new velocity"

    def make(self):
        import pinocchio as pin

        self.pin, self.model = pin, pin.Model()
        joint = self.model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "body")
        self.model.appendBodyToJoint(joint, pin.Inertia(1.0, np.zeros(3), np.diag(self.moments)), pin.SE3.Identity())
        self.model.gravity = pin.Motion.Zero()
        self.data, self.none = self.model.createData(), np.zeros(6)
        self.q, self.v = pin.neutral(self.model), np.concatenate([np.zeros(3), self.rates])

    def advance(self, steps):
        aba, integrate, h = self.pin.aba, self.pin.integrate, self.step
        for _ in range(steps):
            self.v = self.v + h * aba(self.model, self.data, self.q, self.v, self.none)
            self.q = integrate(self.model, self.q, h * self.v)

    def read(self):
        x, y, z, w = self.q[3:]
        return np.array([w, x, y, z]), self.v[3:].copy()


class Dart(Engine):
    title, package, usual, color = "DART", "dartpy", 0.001, "#e377c2"
    setting = "`World.step`, a free joint"

    def make(self):
        import dartpy as dart

        self.world, self.frame = dart.simulation.World("space"), dart.dynamics.Frame.World()
        self.world.setGravity([0, 0, 0])
        self.world.setTimeStep(self.step)
        awake = self.world.getDeactivationOptions()
        awake.mEnabled = False
        self.world.setDeactivationOptions(awake)
        skeleton = dart.dynamics.Skeleton("body")
        _, self.body = skeleton.createFreeJointAndBodyNodePair()
        self.body.setInertia(dart.dynamics.Inertia(1.0, np.zeros(3), np.diag(self.moments)))
        self.world.addSkeleton(skeleton)
        skeleton.setVelocities(np.concatenate([self.rates, np.zeros(3)]))

    def advance(self, steps):
        step = self.world.step
        for _ in range(steps):
            step()

    def read(self):
        q = self.body.getTransform().quaternion()
        rates = self.body.getAngularVelocity(self.frame, self.body)
        return np.array([q.w(), q.x(), q.y(), q.z()]), np.array(rates)


class Brax(Engine):
    package, digits, usual = "brax", "single", 0.002
    pipeline, title, color, setting = "generalized", "brax, generalized", "#bcbd22", "`brax.generalized.pipeline`"

    def make(self):
        import jax
        import jax.numpy as jnp
        from brax.io import mjcf

        pipeline = importlib.import_module(f"brax.{self.pipeline}.pipeline")
        inertia = " ".join(map(repr, map(float, self.moments)))
        system = mjcf.loads(
            '<mujoco><option gravity="0 0 0"/><worldbody><body><freejoint/><inertial pos="0 0 0" mass="1" '
            f'diaginertia="{inertia}"/><geom type="sphere" size="0.1" mass="0" contype="0" conaffinity="0"/>'
            '</body></worldbody></mujoco>')
        self.step = float(np.float32(self.step))
        system = system.tree_replace({"opt.timestep": self.step})
        none = jnp.zeros(0)
        self.wait = jax.block_until_ready
        self.forward = jax.jit(
            lambda state, steps: jax.lax.fori_loop(0, steps, lambda _, now: pipeline.step(system, now, none), state))
        self.state = pipeline.init(system, system.init_q, jnp.zeros(6).at[3:].set(self.rates))
        # Compiled here, and not while it is timed.
        self.wait(self.forward(self.state, 1))

    def advance(self, steps):
        self.state = self.wait(self.forward(self.state, steps))

    def read(self):
        q = np.array(self.state.x.rot[0], float)
        return q, matrix(q).T @ np.array(self.state.xd.ang[0], float)


class BraxPositional(Brax):
    pipeline, title, color, setting = "positional", "brax, positional", "#dbdb8d", "`brax.positional.pipeline`"


class BraxSpring(Brax):
    pipeline, title, color, setting = "spring", "brax, spring", "#8c8c00", "`brax.spring.pipeline`"


class Newton(Engine):
    package, digits, solver, options = "newton", "single", "SolverXPBD", {}
    title, color, setting = "Newton XPBD", "#17becf", "`SolverXPBD`, on the processor"

    def make(self):
        import newton
        import warp

        warp.config.quiet = True
        builder = newton.ModelBuilder(gravity=(0, 0, 0))
        builder.add_body(mass=1.0, inertia=warp.mat33(*np.diag(self.moments).ravel()))
        model = builder.finalize(device="cpu")
        self.step = float(np.float32(self.step))
        self.solver = getattr(newton.solvers, self.solver)(model, **self.options)
        self.now, self.next, self.control = model.state(), model.state(), model.control()
        motion = np.concatenate([np.zeros(3), self.rates]).astype(np.float32)
        self.now.body_qd.assign(motion[None])
        self.now.joint_qd.assign(motion)
        newton.eval_fk(model, self.now.joint_q, self.now.joint_qd, self.now)

    def advance(self, steps):
        for _ in range(steps):
            self.now.clear_forces()
            self.solver.step(self.now, self.next, self.control, None, self.step)
            self.now, self.next = self.next, self.now

    def read(self):
        x, y, z, w = map(float, self.now.body_q.numpy()[0, 3:])
        q = np.array([w, x, y, z])
        return q, matrix(q).T @ self.now.body_qd.numpy()[0, 3:].astype(float)


class NewtonSemiImplicit(Newton):
    solver, options, title, color = "SolverSemiImplicit", {"angular_damping": 0.0}, "Newton semi-implicit", "#9edae5"
    setting = "`SolverSemiImplicit(angular_damping=0)`, on the processor"


class NewtonFeatherstone(Newton):
    solver, options, title, color = "SolverFeatherstone", {"angular_damping": 0.0}, "Newton Featherstone", "#0b7c88"
    setting = "`SolverFeatherstone(angular_damping=0)`, on the processor"


class Basilisk(Engine):
    title, package, color = "Basilisk RK4", "bsk", "#ff7f0e"
    setting = "`spacecraft.Spacecraft` with its default integrator"

    def make(self):
        from Basilisk.simulation import spacecraft
        from Basilisk.utilities import SimulationBaseClass

        # Its clock counts nanoseconds.
        self.nanoseconds, self.made = round(self.step * 1e9), 0
        self.step = self.nanoseconds * 1e-9
        self.simulation = SimulationBaseClass.SimBaseClass()
        self.simulation.CreateNewProcess("process").addTask(self.simulation.CreateNewTask("task", self.nanoseconds))
        self.body = spacecraft.Spacecraft()
        self.body.hub.mHub = 1.0
        self.body.hub.IHubPntBc_B = np.diag(self.moments).tolist()
        self.body.hub.sigma_BNInit = [[0], [0], [0]]
        self.body.hub.omega_BN_BInit = self.rates[:, None].tolist()
        self.simulation.AddModelToTask("task", self.body)
        self.simulation.InitializeSimulation()

    def advance(self, steps):
        self.made += steps
        self.simulation.ConfigureStopTime(self.made * self.nanoseconds)
        self.simulation.ExecuteSimulation()

    def read(self):
        state = self.body.scStateOutMsg.read()
        sigma = np.array(state.sigma_BN)
        square = sigma @ sigma
        return np.concatenate([[1 - square], 2 * sigma]) / (1 + square), np.array(state.omega_BN_B)


class Scipy(Engine):
    title, package, color, adaptive = "SciPy DOP853", "scipy", "#7f7f7f", True
    method, tolerances, setting = "DOP853", {}, "`solve_ivp`, rtol 1e-3 and atol 1e-6, the defaults"

    def make(self):
        i1, i2, i3 = map(float, self.moments)

        def slope(_, y):
            a, b, c, d, x, y, z = y
            return [-(b * x + c * y + d * z) / 2, (a * x + c * z - d * y) / 2, (a * y + d * x - b * z) / 2,
                    (a * z + b * y - c * x) / 2, (i2 - i3) / i1 * y * z, (i3 - i1) / i2 * z * x, (i1 - i2) / i3 * x * y]

        self.slope, self.state = slope, np.concatenate([[1, 0, 0, 0], self.rates])

    def solve(self, times):
        from scipy.integrate import solve_ivp

        return solve_ivp(self.slope, (0, times[-1]), self.state, self.method, t_eval=times, **self.tolerances).y.T

    def advance(self, steps):
        self.state = self.solve([steps * self.step])[-1]

    def record(self, count, every, end):
        # A call for some hundred rows, as each chooses its first step anew.
        rows = []
        while sum(map(len, rows)) < count and time.monotonic() < end:
            block = min(200, count - sum(map(len, rows)))
            rows.append(self.solve(np.arange(1, block + 1) * every * self.step))
            self.state = rows[-1][-1]
        return np.concatenate(rows)


class ScipyFine(Scipy):
    title, color, tolerances = "SciPy DOP853, fine", "#333333", {"rtol": 1e-10, "atol": 1e-12}
    setting = "`solve_ivp`, rtol 1e-10 and atol 1e-12"


class ScipyLsoda(Scipy):
    title, color, method = "SciPy LSODA", "#c7c7c7", "LSODA"


class Node(Engine):
    """An engine for JavaScript, in a process of Node that is asked line by line (engines.mjs)."""

    digits, usual, modules, engine = "single", 1 / 60, None, ""

    def make(self):
        # Where the packages are is told by the one who has installed them.
        if self.digits == "single":
            self.step = float(np.float32(self.step))
        self.node = subprocess.Popen(["node", str(HERE / "engines.mjs"), str(Node.modules)], stdin=subprocess.PIPE,
                                     stdout=subprocess.PIPE, text=True)
        self.ask(engine=self.engine, moments=list(self.moments), rates=list(self.rates), step=self.step)

    def ask(self, **question):
        self.node.stdin.write(json.dumps(question) + "\n")
        self.node.stdin.flush()
        line = self.node.stdout.readline()
        if not line:
            raise RuntimeError(f"{self.title} has ended with {self.node.wait()}")
        return json.loads(line)

    def record(self, count, every, end):
        rows = []
        while len(rows) < count and time.monotonic() < end:
            rows += self.ask(count=min(100, count - len(rows)), every=every)["rows"]
        rows = np.array(rows, float)
        q = rows[:, :4]
        return np.concatenate([q, [matrix(a).T @ w for a, w in zip(q, rows[:, 4:])]], axis=1)

    def seconds(self, steps):
        return self.ask(count=1, every=steps)["seconds"]

    def close(self):
        self.node.stdin.close()
        self.node.wait()

    @classmethod
    def version(cls):
        return json.loads((pathlib.Path(Node.modules) / cls.package / "package.json").read_text())["version"]


class Rapier(Node):
    title, package, engine, color = "Rapier", "@dimforge/rapier3d-compat", "rapier", "#a55194"
    setting = "`World.step`, in WebAssembly"


class Cannon(Node):
    title, package, engine, color, digits = "cannon-es", "cannon-es", "cannon", "#ce6dbd", "double"
    setting = "`World.step`"


class Jolt(Node):
    title, package, engine, color, usual = "Jolt", "jolt-physics", "jolt", "#637939", None
    setting = "`mApplyGyroscopicForce` false, the default; in WebAssembly"


class JoltGyroscopic(Jolt):
    title, engine, color = "Jolt, gyroscopic", "jolt-gyroscopic", "#b5cf6b"
    setting = "`mApplyGyroscopicForce` true; in WebAssembly"


ENGINES = {engine.__name__: engine for engine in (
    Ours, OursExact, Mujoco, MujocoImplicit, MujocoRunge, Bullet, BulletRigid, Drake, DrakeContinuous, Pinocchio, Dart, Brax,
    BraxPositional, BraxSpring, Newton, NewtonSemiImplicit, NewtonFeatherstone, Rapier, Cannon, Jolt, JoltGyroscopic, Basilisk,
    Scipy, ScipyFine, ScipyLsoda)}

# Engines that were asked for and have no such body.
LEFT_OUT = {
    "JSBSim": "it has no body without a planet",
    "Genesis": "it needs PyTorch, of some gigabytes, for one body",
}
