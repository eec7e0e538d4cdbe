"""The same functions by several generators, each of which differentiates by itself.

    python peers.py EXPORTER_DIRECTORY OUTPUT_DIRECTORY

writes `ours.json`, `wrenfold.rs`, `symforce.rs`, `casadi_peer.c` and `main.rs`, a program that times
them. A generator that cannot be imported is left out.
"""

import json
import random
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, sys.argv[1])
OUTPUT = Path(sys.argv[2])

import casadi as ca  # noqa: E402
from casadi_program import Element, Function, Group, Output, Program, jacobian_output  # noqa: E402

DEG_PER_HOUR = 4.84813681109536e-6
POINTS = 64


def product(a, b):
    return [[sum_of([x * b[k][j] for k, x in enumerate(row)]) for j in range(len(b[0]))] for row in a]


def sum_of(terms):
    result = terms[0]
    for term in terms[1:]:
        result = result + term
    return result


def times(a, v):
    return [row[0] for row in product(a, [[x] for x in v])]


def turn(m, axis, angle):
    c, s = m.cos(angle), m.sin(angle)
    return [[[1, 0, 0], [0, c, s], [0, -s, c]], [[c, 0, -s], [0, 1, 0], [s, 0, c]],
            [[c, s, 0], [-s, c, 0], [0, 0, 1]]][axis]


def attitude(m, t):
    return product(product(turn(m, 2, t[2]), turn(m, 1, t[1])), turn(m, 0, t[0]))


def platform_force(m, theta, f):
    return times(attitude(m, theta), f)


def platform_dynamics(m, theta, drift, omega, f):
    a = platform_force(m, theta, f)
    law = [drift[3 * i] + drift[3 * i + 1] * a[i] + drift[3 * i + 2] * a[i] * a[i] for i in range(3)]
    earth = times(attitude(m, theta), omega)
    rate = [DEG_PER_HOUR * law[i] - earth[i] for i in range(3)]
    cy, sy, cz, sz = m.cos(theta[1]), m.sin(theta[1]), m.cos(theta[2]), m.sin(theta[2])
    return times([[cz / cy, -sz / cy, 0], [sz, cz, 0], [-sy * cz / cy, sy * sz / cy, 1]], rate)


def quadrotor_rates(m, angles, bias, omega):
    phi, theta = angles[0], angles[1]
    body = [omega[i] - bias[i] for i in range(3)]
    tan, cos = m.sin(theta) / m.cos(theta), m.cos(theta)
    s, c = m.sin(phi), m.cos(phi)
    return times([[1, s * tan, c * tan], [0, c, -s], [0, s / cos, c / cos]], body)


def quadrotor_reading(m, angles, field):
    body = product(product(turn(m, 0, angles[0]), turn(m, 1, angles[1])), turn(m, 2, angles[2]))
    return times(body, [0, 0, -1]) + times(body, field)


def arm(m, joints):
    """Rotation and place of the flange of an arm with seven joints."""
    rotation, place = [[1, 0, 0], [0, 1, 0], [0, 0, 1]], [0, 0, 0]
    for i, (axis, length) in enumerate(zip([2, 0, 2, 0, 2, 0, 2], [0.3, 0, 0.4, 0, 0.39, 0, 0.08])):
        back = turn(m, axis, joints[i])
        rotation = product(rotation, [[back[c][r] for c in range(3)] for r in range(3)])
        if length:
            place = [p + length * row[2] for p, row in zip(place, rotation)]
    return [x for row in rotation for x in row] + place


def cart_pole(m, state, friction, force):
    theta, velocity, rate = state[1], state[2], state[3]
    s, c = m.sin(theta), m.cos(theta)
    along = force[0] - friction[0] * velocity + 0.1 * rate * rate * s
    about = -friction[1] * rate - 0.981 * s
    determinant = 0.06 - 0.01 * c * c
    return [velocity, rate, (0.05 * along - 0.1 * c * about) / determinant,
            (1.2 * about - 0.1 * c * along) / determinant]


# Name: function, inputs with their lengths, those that it is differentiated by, angles of the first.
FUNCTIONS = {
    "platform_dynamics": (platform_dynamics, {"theta": 3, "drift": 9, "omega": 3, "f": 3},
                          ["theta", "drift"], [0, 1, 2]),
    "platform_force": (platform_force, {"theta": 3, "f": 3}, ["theta"], [0, 1, 2]),
    "quadrotor_rates": (quadrotor_rates, {"angles": 3, "bias": 3, "omega": 3}, ["angles", "bias"],
                        [0, 1]),
    "quadrotor_reading": (quadrotor_reading, {"angles": 3, "field": 3}, ["angles"], [0, 1, 2]),
    "arm": (arm, {"joints": 7}, ["joints"], list(range(7))),
    "cart_pole": (cart_pole, {"state": 4, "friction": 2, "force": 1}, ["state", "friction"], [1]),
}


def ours_and_casadi():
    groups = {}
    functions, generator = [], ca.CodeGenerator("casadi_peer.c", {"with_header": False})
    shapes = {}
    for name, (build, inputs, by, _) in FUNCTIONS.items():
        own = {g: groups.setdefault(g + str(n), Group(f"{g}{n}", g, [
            Element(f"{g}{n}_{i}", "1", "element") for i in range(n)])) for g, n in inputs.items()}
        value = Output("y", ca.vertcat(*build(ca, **{g: [own[g].sx[i] for i in range(n)]
                                                     for g, n in inputs.items()})), "1", "value")
        outputs = [value] + [jacobian_output(value, own[g], f"dy_{g}", "Jacobian", "1") for g in by]
        function = Function(name, "Value and Jacobians.", "", list(own.values()), outputs)
        functions.append(function)
        compiled = function.casadi()
        shapes[name] = [(o.name, compiled.size1_out(i), compiled.size2_out(i), compiled.nnz_out(i))
                        for i, o in enumerate(outputs)]
        generator.add(ca.Function(f"casadi_{name}", [g.sx for g in own.values()],
                                  compiled.call([g.sx for g in own.values()])))
    (OUTPUT / "ours.json").write_text(Program("ours", "Functions.", functions).to_json())
    generator.generate(str(OUTPUT) + "/")
    return shapes


def wrenfold():
    from typing import Annotated

    from wrenfold import Shape, code_generation, sym
    text = ""
    for name, (build, inputs, by, _) in FUNCTIONS.items():
        def body(own, build=build, inputs=inputs, by=by):
            value = sym.vector(*build(sym, **{g: [own[g][i] for i in range(n)]
                                              for g, n in inputs.items()}))
            return [code_generation.OutputArg(value, "y")] + [
                code_generation.OutputArg(sym.jacobian(value, own[g]), f"dy_{g}") for g in by]

        # The generator reads the names and annotations of the arguments.
        scope = {"body": body, "A": Annotated, "M": sym.MatrixExpr, "S": Shape}
        arguments = ", ".join(f"{g}: A[M, S(rows={n}, cols=1)]" for g, n in inputs.items())
        exec(f"def function({arguments}):\n    return body(locals())", scope)
        function = scope["function"]
        text += code_generation.generate_function(function, code_generation.RustGenerator(), name=name)
        text += "\n"
    (OUTPUT / "wrenfold.rs").write_text(text)


def symforce():
    import symforce
    symforce.set_epsilon_to_number(0)
    import symforce.symbolic as sf
    from symforce import codegen
    from symforce.codegen.backends.rust import RustConfig
    from symforce.values import Values
    text = ""
    for name, (build, inputs, by, _) in FUNCTIONS.items():
        own = {g: sf.Matrix(n, 1, list(sf.symbols(" ".join(f"{g}_{i}" for i in range(n)), seq=True)))
               if n > 1 else sf.Matrix([sf.Symbol(f"{g}_0")]) for g, n in inputs.items()}
        value = sf.Matrix(build(sf, **{g: [own[g][i] for i in range(n)] for g, n in inputs.items()}))
        outputs = Values(y=value, **{f"dy_{g}": value.jacobian(own[g]) for g in by})
        with tempfile.TemporaryDirectory() as directory:
            codegen.Codegen(inputs=Values(**own), outputs=outputs, config=RustConfig(),
                            name=name).generate_function(output_dir=directory)
            found, = Path(directory).rglob(f"{name}.rs")
            text += f"pub mod {name} {{\n{found.read_text()}\n}}\n"
    (OUTPUT / "symforce.rs").write_text(text)


HEAD = '''#![allow(warnings)]
#[rustfmt::skip] mod ours;
use std::hint::black_box;
use std::time::Instant;
WRENFOLD
SYMFORCE

#[link(name = "casadi_peer", kind = "static")]
unsafe extern "C" { EXTERN }

fn ulps_apart(a: &[f64], b: &[f64]) -> f64 {
    let scale = a.iter().fold(1e-300_f64, |m, x| m.max(x.abs()));
    a.iter().zip(b).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs())) / scale
}
'''
SPANS = '''pub mod wrenfold_traits {
    pub trait Span2D<const R: usize, const C: usize> { type ValueType; fn get(&self, r: usize, c: usize) -> f64; }
    pub trait OutputSpan2D<const R: usize, const C: usize> { type ValueType; fn set(&mut self, r: usize, c: usize, v: f64); }
    impl<const R: usize> Span2D<R, 1> for [f64; R] { type ValueType = f64; #[inline(always)] fn get(&self, r: usize, _: usize) -> f64 { self[r] } }
    impl<const R: usize, const C: usize> OutputSpan2D<R, C> for [[f64; C]; R] { type ValueType = f64; #[inline(always)] fn set(&mut self, r: usize, c: usize, v: f64) { self[r][c] = v } }
}
mod wrenfold { use super::wrenfold_traits; include!("wrenfold.rs"); }'''


def program(shapes, found):
    rng = random.Random(1)
    text = HEAD.replace("WRENFOLD", SPANS if "wrenfold" in found else "")
    text = text.replace("SYMFORCE", "mod symforce;" if "symforce" in found else "")
    signature = "(a: *const *const f64, r: *const *mut f64, i: *mut i64, w: *mut f64, m: i32) -> i32;"
    text = text.replace("EXTERN", " ".join(f"fn casadi_{name}{signature}" for name in FUNCTIONS))
    main = ""
    for name, (_, inputs, _, angles) in FUNCTIONS.items():
        total, first = sum(inputs.values()), list(inputs)[0]
        pascal = "".join(word.capitalize() for word in name.split("_"))
        scalars = sum(nnz for *_, nnz in shapes[name])
        starts, start = {}, 0
        for group, n in inputs.items():
            starts[group] = (start, n)
            start += n
        slices = ", ".join(f"x[{s}..{s + n}].try_into().unwrap()" for s, n in starts.values())
        ours_out = f"ours::{pascal}<f64>"
        call = (f"ours::{name}_into({slices}, out)" if scalars > 16
                else f"*out = ours::{name}({slices})")
        dense = "".join(f"pub {o}: [[f64; {c}]; {r}], " for o, r, c, _ in shapes[name])
        zero = "".join(f"{o}: [[0.0; {c}]; {r}], " for o, r, c, _ in shapes[name])
        outs = ", ".join(f"&mut out.{o}" for o, *_ in shapes[name])
        text += f"pub struct Dense{pascal} {{ {dense} }}\n"
        text += (f"#[inline(never)] fn ours_{name}(x: &[f64; {total}], out: &mut {ours_out}) {{ {call} }}\n"
                 f"#[inline(never)] fn value_{name}(x: &[f64; {total}]) -> {ours_out} {{ ours::{name}({slices}) }}\n")
        contenders = [("ours", f"ours_{name}(x, &mut a)"), ("value", f"black_box(&value_{name}(x))")]
        checks = ""
        if "wrenfold" in found:
            typed = ", ".join(f"<&[f64; {n}]>::try_from(&x[{s}..{s + n}]).unwrap()" for s, n in starts.values())
            text += (f"#[inline(never)] fn wrenfold_{name}(x: &[f64; {total}], out: &mut Dense{pascal}) "
                     f"{{ wrenfold::{name}({typed}, {outs}) }}\n")
            contenders.append(("wrenfold", f"wrenfold_{name}(x, &mut b)"))
            checks += f"wrenfold_{name}(x, &mut b); apart = apart.max(compare_{name}(&a, &b.y.concat(), &[{', '.join(f'b.{o}.concat()' for o, *_ in shapes[name])}]));\n"
        if "symforce" in found:
            out_type = "".join(f"{o}: nalgebra::SMatrix<f64, {r}, {c}>, " for o, r, c, _ in shapes[name])
            outs_sf = ", ".join(f"Some(&mut out.{o})" for o, *_ in shapes[name])
            vectors = ", ".join(f"&nalgebra::SVector::<f64, {n}>::from_column_slice(&x[{s}..{s + n}])" for s, n in starts.values())
            text += f"struct Symforce{pascal} {{ {out_type} }}\n"
            groups = ", ".join(f"nalgebra::SVector<f64, {n}>" for n in inputs.values())
            passed = ", ".join(f"&x.{i}" for i in range(len(inputs)))
            text += (f"type Vectors{pascal} = ({groups},);\n"
                     f"#[inline(never)] fn symforce_{name}(x: &Vectors{pascal}, out: &mut Symforce{pascal}) "
                     f"{{ symforce::{name}::sym::{name}({passed}, {outs_sf}) }}\n"
                     f"fn vectors_{name}(x: &[f64; {total}]) -> Vectors{pascal} {{ ({vectors.replace('&nalgebra', 'nalgebra')},) }}\n")
            contenders.append(("symforce", f"symforce_{name}(v, &mut c)"))
            rows = ", ".join(f"c.{o}.transpose().as_slice().to_vec()" for o, *_ in shapes[name])
            checks += f"symforce_{name}(&vectors_{name}(x), &mut c); apart = apart.max(compare_{name}(&a, c.y.as_slice(), &[{rows}]));\n"
        results = "".join(f"{o}: [f64; {nnz}], " for o, *_, nnz in shapes[name])
        arguments = ", ".join(f"x[{s}..].as_ptr()" for s, _ in starts.values())
        pointers = ", ".join(f"out.{o}.as_mut_ptr()" for o, *_ in shapes[name])
        text += (f"struct Casadi{pascal} {{ {results} }}\n"
                 f"#[inline(never)] fn casadi_{name}_call(x: &[f64; {total}], out: &mut Casadi{pascal}) {{ unsafe {{ "
                 f"casadi_{name}([{arguments}].as_ptr(), [{pointers}].as_ptr(), std::ptr::null_mut(), std::ptr::null_mut(), 0); }} }}\n")
        contenders.append(("casadi", f"casadi_{name}_call(x, &mut d)"))
        empty = "".join(f"{o}: [0.0; {nnz}], " for o, *_, nnz in shapes[name])
        sines = " ".join(f"out[{i}] = gyrocal_scalar::sin_cos_f64(x[{starts[first][0] + k}]);" for i, k in enumerate(angles))
        text += f"#[inline(never)] fn sines_{name}(x: &[f64; {total}], out: &mut [(f64, f64); {len(angles)}]) {{ {sines} }}\n"
        contenders.append(("sines", f"sines_{name}(x, &mut e)"))
        compare = ""
        for k, (o, r, c, nnz) in enumerate(shapes[name]):
            ours = (f"a.{o}.to_vec()" if nnz == r * c and c == 1 else f"a.{o}.concat()" if nnz == r * c
                    else f"a.{o}_dense().concat()")
            compare += f"apart = apart.max(ulps_apart(&{ours}, &all[{k}]));\n"
        text += (f"fn compare_{name}(a: &{ours_out}, y: &[f64], all: &[Vec<f64>]) -> f64 {{ let mut apart = 0.0_f64; {compare} apart }}\n")
        base = [[rng.uniform(0.5, 1.5) * rng.choice([-1, 1]) for _ in range(total)] for _ in range(POINTS)]
        text += f"const POINTS_{name.upper()}: [[f64; {total}]; {POINTS}] = {base!r};\n"
        scaled = " ".join(f"x[{starts[first][0] + k}] *= angle / 1.5;" for k in angles)
        arms = "".join(f'"{label}" => for (x, v) in points.iter().zip(&vectors) {{ {code}; black_box((&a, &b, &c, &d, &e)); }}\n'
                       for label, code in contenders)
        labels = ", ".join(f'"{label}"' for label, _ in contenders)
        main += f'''
fn run_{name}(angle: f64, rounds: usize, only: Option<&str>) {{
    let mut points = POINTS_{name.upper()};
    for x in &mut points {{ {scaled} }}
    let vectors: Vec<_> = points.iter().map(|x| {'vectors_' + name + '(x)' if 'symforce' in found else '()'}).collect();
    let mut a = ours::{name}({slices.replace('x[', 'points[0][')});
    let mut b = Dense{pascal} {{ {zero} }};
    let mut c = {'Symforce' + pascal + ' { ' + ''.join(f'{o}: nalgebra::SMatrix::zeros(), ' for o, *_ in shapes[name]) + '}' if 'symforce' in found else '()'};
    let mut d = Casadi{pascal} {{ {empty} }};
    let mut e = [(0.0, 0.0); {len(angles)}];
    let mut apart = 0.0_f64;
    for x in &points {{ ours_{name}(x, &mut a); {checks} }}
    let labels = [{labels}];
    let mut best = [f64::MAX; {len(contenders)}];
    for _ in 0..rounds {{
        for (label, best) in labels.iter().zip(&mut best) {{
            if only.is_some_and(|only| only != *label) {{ continue; }}
            let begin = Instant::now();
            for _ in 0..16 {{ match *label {{ {arms} _ => {{}} }} }}
            *best = best.min(begin.elapsed().as_secs_f64() * 1e9 / (16 * {POINTS}) as f64);
        }}
    }}
    if only.is_some() {{ return; }}
    print!("{name} {{angle}} apart={{apart:e}}");
    for (label, best) in labels.iter().zip(best) {{ print!(" {{label}}={{best:.3}}"); }}
    println!();
}}
'''
    runs = "".join(f'"{name}" => run_{name}(angle, rounds, only),\n' for name in FUNCTIONS)
    names = ", ".join(f'"{name}"' for name in FUNCTIONS)
    text += main + f'''
fn main() {{
    let words: Vec<String> = std::env::args().skip(1).collect();
    let rounds: usize = words[0].parse().unwrap();
    let run = |name: &str, angle: f64, only: Option<&str>| match name {{ {runs} _ => panic!() }};
    if let [_, name, label] = &words[..] {{ return run(name, 0.6, Some(label)); }}
    for name in [{names}] {{ for angle in [0.03, 0.6, 3.0] {{ run(name, angle, None); }} }}
}}
'''
    (OUTPUT / "main.rs").write_text(text)


def main():
    shapes = ours_and_casadi()
    found = []
    for peer in (wrenfold, symforce):
        try:
            peer()
            found.append(peer.__name__)
        except ImportError as error:
            print(f"{peer.__name__}: {error}", file=sys.stderr)
    program(shapes, found)
    print(json.dumps(found))


main()
