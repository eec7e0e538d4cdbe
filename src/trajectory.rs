//! Attitudes as points of a trajectory, for batch estimation.

use gyrocal_estimation::{Corrected, Manifold};

use gyrocal_scalar::{Model, Recentre};

use crate::anchor::{Anchored, Chart};
use crate::chart_vectors::ChartInputs;
use crate::rotation::{cross, mean_turn, rotation_vector, turned_by};

/// An attitude: unit vectors North and Up along the platform axes.
pub type Orientation = [[f64; 3]; 2];

impl<D> Manifold<3, 3> for Anchored<D>
where
    D: Model<f64, 3, 3, Inputs: ChartInputs<f64>>,
{
    type Point = Orientation;

    #[inline]
    fn point(&self, moving: &[f64; 3], chart: &Chart<f64, D::Inputs>) -> Orientation {
        let (mut moving, mut chart) = (*moving, *chart);
        if moving != [0.0; 3] {
            self.recentre(&mut moving, &mut chart);
        }
        chart.orientation()
    }

    #[inline]
    fn place(&self, point: &Orientation, moving: &mut [f64; 3], chart: &mut Chart<f64, D::Inputs>) {
        *moving = [0.0; 3];
        chart.set_orientation(point);
    }

    #[inline]
    fn difference(&self, from: &Orientation, to: &Orientation) -> [f64; 3] {
        rotation_vector(&between(from, to))
    }

    #[inline]
    fn corrected(&self, correction: &[f64; 3]) -> Option<Corrected<3>> {
        Some(Corrected {
            point: turned_by(correction),
            correction: mean_turn(correction),
        })
    }
}

/// The orientation of a platform whose components from East, North, Up components are given.
#[must_use]
pub fn orientation(platform_c_enu: &[[f64; 3]; 3]) -> Orientation {
    [1, 2].map(|column| platform_c_enu.map(|row| row[column]))
}

/// Platform components from East, North, Up components.
#[must_use]
pub fn platform_c_enu([north, up]: &Orientation) -> [[f64; 3]; 3] {
    let east = cross(north, up);
    core::array::from_fn(|i| [east[i], north[i], up[i]])
}

/// Platform angles against East-North-Up, rad: rotations about x, then y, then z.
#[must_use]
pub fn angles_rad(platform_c_enu: &[[f64; 3]; 3]) -> [f64; 3] {
    crate::rotation::angles(platform_c_enu)
}

/// An orientation after the platform turned by a rotation vector along its axes, rad.
#[must_use]
pub fn turned(orientation: &Orientation, rotation: &[f64; 3]) -> Orientation {
    let matrix = turned_by(rotation);
    orientation.map(|vector| crate::rotation::rotate(&matrix, &vector))
}

/// The rotation vector that takes one orientation to the other, along the platform axes, rad.
#[must_use]
pub fn rotation_between(from: &Orientation, to: &Orientation) -> [f64; 3] {
    rotation_vector(&between(from, to))
}

/// Components in the second orientation from components in the first.
fn between(from: &Orientation, to: &Orientation) -> [[f64; 3]; 3] {
    let (from, to) = (platform_c_enu(from), platform_c_enu(to));
    core::array::from_fn(|i| {
        core::array::from_fn(|j| (0..3).map(|axis| to[i][axis] * from[j][axis]).sum())
    })
}
