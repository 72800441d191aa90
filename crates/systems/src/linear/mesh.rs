//! Meshes of linear finite elements, each element kicking with a step of its own: what AVI were made for.
//!
//! Bars, triangles in the plane and tetrahedra of isotropic linear elasticity with lumped masses. With the
//! gradients g_a of the shape functions of a simplex of volume V and Lamé's λ, μ (in plane stress 2λμ/(λ +
//! 2μ) for λ),
//!
//! ```text
//!     K_(ai)(bj) = V (λ g_ai g_bj + μ (g_aj g_bi + δ_ij g_a·g_b)),      a bar: E A/L³ Δ Δᵀ,
//! ```
//!
//! exact over ℚ, but for the length of a bar whose square is no square of a rational: that one is rounded to
//! a double. Elements of equal steps share a clock; a kick moves the nodes of its elements alone.

use std::collections::{BTreeMap, BTreeSet};

use num_traits::{One, Signed, Zero};

use crate::linear::sparse::{Symmetric, dot};
use crate::linear::system::{Potential, System};
use number::{Error, Rational, Result, from_f64_exact, to_f64};

/// The material of the elements.
#[derive(Clone, Debug)]
pub struct Material {
    /// E, force/length².
    pub young: Rational,
    /// ν, in (−1, 1/2).
    pub poisson: Rational,
    /// Mass/volume.
    pub density: Rational,
    /// The thickness of triangles, the cross-section of bars; not used for tetrahedra.
    pub thickness: Rational,
    /// Triangles in plane strain, not in plane stress.
    pub is_plane_strain: bool,
}

/// Nodes, elements and what holds them.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// 1 to 3 coordinates each.
    pub nodes: Vec<Vec<Rational>>,
    /// The nodes of each element, and its step: 2 nodes are a bar, 3 a triangle in the plane, 4 a
    /// tetrahedron.
    pub elements: Vec<(Vec<usize>, Rational)>,
    /// (node, axis) pairs that do not move.
    pub fixed: BTreeSet<(usize, usize)>,
    pub material: Material,
}

impl Mesh {
    /// The system of all (node, axis) pairs that move, and these.
    ///
    /// # Errors
    /// Names the element: too many or too few nodes for the space, one that is not there, no volume; a
    /// material that is none; a node that moves but belongs to no element; and as [`System::new`].
    pub fn system(&self) -> Result<(System, Vec<(usize, usize)>)> {
        self.check()?;
        let axes = self.nodes.first().map_or(0, Vec::len);
        let all = (0..self.nodes.len()).flat_map(|node| (0..axes).map(move |axis| (node, axis)));
        let moving: Vec<_> = all.filter(|place| !self.fixed.contains(place)).collect();
        let index: BTreeMap<_, _> = moving.iter().enumerate().map(|(i, &place)| (place, i)).collect();
        let mut masses = vec![Rational::zero(); self.nodes.len()];
        let mut clocks: BTreeMap<&Rational, Symmetric> = BTreeMap::new();
        for (e, (nodes, step)) in self.elements.iter().enumerate() {
            let element = self.element(e)?;
            let share = &element.mass / Rational::from_integer(nodes.len().into());
            nodes.iter().for_each(|&node| masses[node] += &share);
            let stiffness = clocks.entry(step).or_insert_with(|| Symmetric::zero(moving.len()));
            let places: Vec<_> =
                nodes.iter().flat_map(|&node| (0..axes).map(move |axis| (node, axis))).collect();
            for (a, first) in places.iter().enumerate() {
                for (b, second) in places.iter().enumerate().take(a + 1) {
                    if let (Some(&i), Some(&j)) = (index.get(first), index.get(second)) {
                        stiffness.add(i, j, &(element.stiffness)(a, b));
                    }
                }
            }
        }
        if let Some(&(node, _)) = moving.iter().find(|(node, _)| masses[*node].is_zero()) {
            let remedy = "belongs to no element, so it has no mass: leave it out, or hold it";
            return Err(Error::input(&format!("mesh.nodes[{node}]"), "no mass", remedy));
        }
        let masses: Vec<_> = moving.iter().map(|(node, _)| masses[*node].clone()).collect();
        let potentials =
            clocks.into_iter().map(|(step, symmetric)| Potential::new(symmetric, step.clone())).collect();
        Ok((System::new(Symmetric::diagonal(&masses), potentials)?, moving))
    }

    /// That the nodes are in one space, the material is one, and what is fixed is there.
    ///
    /// # Errors
    /// Names the field.
    pub fn check(&self) -> Result<()> {
        let axes = self.nodes.first().map_or(0, Vec::len);
        if !(1..=3).contains(&axes) {
            return Err(Error::input("mesh.nodes", axes, "give 1 to 3 coordinates for each node"));
        }
        if let Some(node) = self.nodes.iter().position(|x| x.len() != axes) {
            let remedy = format!("the first node has {axes} coordinates: give as many for each");
            return Err(Error::input(&format!("mesh.nodes[{node}]"), self.nodes[node].len(), remedy));
        }
        let Material { young, poisson, density, thickness, .. } = &self.material;
        for (name, value) in [("young", young), ("density", density), ("thickness", thickness)] {
            if !value.is_positive() {
                return Err(Error::input(&format!("mesh.{name}"), value, "must be positive"));
            }
        }
        if *poisson <= -Rational::one() || *poisson >= Rational::new(1.into(), 2.into()) {
            return Err(Error::input("mesh.poisson", poisson, "must be above -1 and below 1/2"));
        }
        if let Some((node, axis)) =
            self.fixed.iter().find(|(node, axis)| *node >= self.nodes.len() || *axis >= axes)
        {
            let remedy = format!("nodes are 0 to {}, axes 0 to {}", self.nodes.len() - 1, axes - 1);
            return Err(Error::input("mesh.fixed", format!("node {node}, axis {axis}"), remedy));
        }
        Ok(())
    }

    /// Mass and stiffness of one element, its degrees of freedom node by node.
    fn element(&self, e: usize) -> Result<Element<'_>> {
        let field = format!("mesh.elements[{e}]");
        let own = &self.elements[e].0;
        if let Some(node) = own.iter().find(|&&node| node >= self.nodes.len()) {
            return Err(Error::input(&field, node, format!("nodes are 0 to {}", self.nodes.len() - 1)));
        }
        let axes = self.nodes[0].len();
        let corners: Vec<&[Rational]> = own.iter().map(|&node| self.nodes[node].as_slice()).collect();
        let element = match (own.len(), axes) {
            (2, _) => self.bar(&corners),
            (3, 2) | (4, 3) => self.simplex(&corners),
            (n, _) => {
                let remedy = "2 nodes are a bar, 3 a triangle in the plane, 4 a tetrahedron in space";
                return Err(Error::input(&field, format!("{n} nodes with {axes} coordinates each"), remedy));
            }
        };
        element.ok_or_else(|| {
            Error::input(&field, format!("{own:?}"), "its nodes span no length, area or volume")
        })
    }

    /// m = ρ A L, K = E A/L³ Δ Δᵀ.
    fn bar(&self, corners: &[&[Rational]]) -> Option<Element<'_>> {
        let along: Vec<Rational> = corners[1].iter().zip(corners[0]).map(|(b, a)| b - a).collect();
        let square = dot(&along, &along);
        if square.is_zero() {
            return None;
        }
        let length = root(&square)?;
        let Material { young, density, thickness, .. } = &self.material;
        let factor = young * thickness / (&square * &length);
        let axes = along.len();
        let stiffness = move |a: usize, b: usize| {
            let own = &factor * &along[a % axes] * &along[b % axes];
            if a / axes == b / axes { own } else { -own }
        };
        Some(Element { mass: density * thickness * length, stiffness: Box::new(stiffness) })
    }

    fn simplex(&self, corners: &[&[Rational]]) -> Option<Element<'_>> {
        let (gradients, volume) = gradients(corners)?;
        let axes = corners[0].len();
        let volume = if axes == 2 { volume * &self.material.thickness } else { volume };
        let (lambda, mu) = self.material.lame(axes == 2);
        let mass = &self.material.density * &volume;
        let stiffness = move |p: usize, q: usize| {
            let (a, i, b, j) = (&gradients[p / axes], p % axes, &gradients[q / axes], q % axes);
            let shear = if i == j { dot(a, b) } else { Rational::zero() };
            (&lambda * &a[i] * &b[j] + &mu * (&a[j] * &b[i] + shear)) * &volume
        };
        Some(Element { mass, stiffness: Box::new(stiffness) })
    }
}

struct Element<'a> {
    mass: Rational,
    stiffness: Box<dyn Fn(usize, usize) -> Rational + 'a>,
}

impl Material {
    /// λ and μ; in plane stress 2λμ/(λ + 2μ) in place of λ.
    fn lame(&self, is_plane: bool) -> (Rational, Rational) {
        let (one, two) = (Rational::one(), Rational::from_integer(2.into()));
        let mu = &self.young / (&two * (&one + &self.poisson));
        let lambda = &self.young * &self.poisson / ((&one + &self.poisson) * (&one - &two * &self.poisson));
        if is_plane && !self.is_plane_strain {
            let plane = &two * &lambda * &mu / (&lambda + &two * &mu);
            return (plane, mu);
        }
        (lambda, mu)
    }
}

/// √x: exact for the square of a rational, else to the nearest double; `None` below 0 and beyond all doubles.
pub fn root(x: &Rational) -> Option<Rational> {
    if x.is_negative() {
        return None;
    }
    let exact = Rational::new(x.numer().sqrt(), x.denom().sqrt());
    if &exact * &exact == *x { Some(exact) } else { from_f64_exact(to_f64(x).sqrt()) }
}

/// The gradients of the shape functions of a triangle or tetrahedron and its volume; `None` where that is 0.
fn gradients(corners: &[&[Rational]]) -> Option<(Vec<Vec<Rational>>, Rational)> {
    let edges: Vec<Vec<Rational>> =
        corners[1..].iter().map(|x| x.iter().zip(corners[0]).map(|(b, a)| b - a).collect()).collect();
    // Rows of the cofactors: the gradient of corner k + 1 is row k over the determinant.
    let cofactors: Vec<Vec<Rational>> = match edges.as_slice() {
        [u, v] => vec![vec![v[1].clone(), -&v[0]], vec![-&u[1], u[0].clone()]],
        [u, v, w] => vec![cross(v, w), cross(w, u), cross(u, v)],
        _ => return None,
    };
    let determinant = dot(&edges[0], &cofactors[0]);
    if determinant.is_zero() {
        return None;
    }
    let mut all: Vec<Vec<Rational>> =
        cofactors.iter().map(|row| row.iter().map(|x| x / &determinant).collect()).collect();
    let first = (0..edges.len()).map(|i| -all.iter().map(|g| &g[i]).sum::<Rational>()).collect();
    all.insert(0, first);
    let factorial = if edges.len() == 2 { 2 } else { 6 };
    Some((all, determinant.abs() / Rational::from_integer(factorial.into())))
}

fn cross(u: &[Rational], v: &[Rational]) -> Vec<Rational> {
    let entry = |i: usize, j: usize| &u[i] * &v[j] - &u[j] * &v[i];
    vec![entry(1, 2), entry(2, 0), entry(0, 1)]
}
