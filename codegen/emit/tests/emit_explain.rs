//! The account of a function.
#![cfg(test)]

mod common;

use common::{one_function, pendulum};
use gyrocal_codegen::{Program, explain};

#[test]
fn an_account_tells_what_was_simplified_and_shared() {
    // y0 = (x0 + 0) x1, y1 = sin(x0 x1) / (x0 x1).
    let text = one_function(
        2,
        2,
        r#"["input",0,0,0],["input",1,0,1],["const",2,0],["add",3,0,2],["mul",4,3,1],
           ["output",0,0,4],["sin",5,4],["div",6,5,4],["output",1,0,6]"#,
    );
    let program = Program::from_json(&text, "test.json").unwrap();
    let account = explain(&program, "f").unwrap();
    let expected = "f: 9 instructions

operations
      4  as derived, equal subexpressions joined: 1 addition, 1 multiplication, 1 division, \
                    1 sine-cosine pair.
      3  folded, identities, negations pulled out: 1 multiplication, 1 division, \
                    1 sine-cosine pair.
      3  reciprocals of common denominators shared: 1 multiplication, 1 division, \
                    1 sine-cosine pair.
      3  negations put where they cost nothing: 1 multiplication, 1 division, \
                    1 sine-cosine pair.

by operation
      1  div
      1  mul
      1  sin_cos

critical path: 3 operations, to row 0, column 0 of `y1`
         mul sin div

shared subexpressions: 1; uses, operations of each, expression
      3      1  s1 = x0 * x1

output `y0`: 1 x 1, 1 of 1 structural nonzeros
         x

output `y1`: 1 x 1, 1 of 1 structural nonzeros
         x
";
    assert_eq!(account, expected);
}

#[test]
fn an_account_shows_the_structure_of_a_jacobian() {
    let account = explain(&pendulum(), "swing_rates_jacobian").unwrap();
    let picture = "output `swing_dot_d_swing`: 2 x 2, 3 of 4 structural nonzeros\n         \
                   .x  angle_dot\n         xx  rate_dot\n";
    assert!(account.contains(picture), "{account}");
}

#[test]
fn an_unknown_function_is_named() {
    let error = explain(&pendulum(), "swing").unwrap_err().to_string();
    assert!(
        error.contains("found the function `swing`, expected one of swing_rates"),
        "{error}"
    );
}
