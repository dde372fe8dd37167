//! Links and the joints between them, as trees that hang on the world: what formats state as a list becomes bodies of the scene.

use super::joint::{Joint, Link};
use crate::assembly::{Assembly, Contents};
use enfilade_math::DAffine3;
use std::collections::BTreeSet;

/// A joint between two links.
pub(crate) struct Edge {
    pub joint: Joint,
    /// True if it holds both together.
    pub is_fixed: bool,
    /// The link that bears and the one that is borne, among all; `None` is the world.
    pub ends: [Option<usize>; 2],
}

/// A link, and what was made of it.
pub(crate) struct Piece {
    pub name: String,
    pub file_from_link: DAffine3,
    /// Spans of contents, in their order: what is of another link is left out.
    pub contents: Vec<[Contents; 2]>,
}

/// Trees of links, in the order of their bodies.
pub(crate) struct Trees {
    /// Joints that move.
    pub joints: Vec<Joint>,
    /// Links; what bears a link comes before it, and the first is the world.
    pub links: Vec<Link>,
    /// The joint that moves each link, if any.
    movers: Vec<Option<usize>>,
    /// By link, the piece that it is; none of the world.
    pieces: Vec<Option<usize>>,
}

impl Trees {
    /// The trees, and the names of joints that would close a circle, which are in none of them. A tree hangs on the world, else on the link
    /// that no joint bears, else on its first link; joints are turned round where they point to that.
    pub(crate) fn grown(pieces: &[Piece], edges: Vec<Edge>) -> (Self, Vec<String>) {
        let world = Link { name: "world".into(), file_from_link: DAffine3::IDENTITY, jointed: false, mocap: false, body: None, parent: 0 };
        let mut trees = Self { joints: Vec::new(), links: vec![world], movers: vec![None], pieces: vec![None] };
        let mut edges: Vec<Option<Edge>> = edges.into_iter().map(Some).collect();
        let mut at: Vec<Option<usize>> = vec![None; pieces.len()];
        let borne: BTreeSet<usize> = edges.iter().flatten().filter_map(|edge| edge.ends[1]).collect();
        let free: Vec<usize> = (0..pieces.len()).filter(|piece| !borne.contains(piece)).collect();
        trees.hang(pieces, &mut edges, &mut at, 0, None);
        for root in free.into_iter().chain(0..pieces.len()) {
            if at[root].is_none() {
                let link = trees.push(pieces, root, 0, None);
                at[root] = Some(link);
                trees.hang(pieces, &mut edges, &mut at, link, Some(root));
            }
        }
        let left = edges.into_iter().flatten().map(|edge| edge.joint.name).collect();
        (trees, left)
    }

    /// Hangs on a link all that joints lead to from there: along them first, breadth first, and only where that ends against them.
    fn hang(&mut self, pieces: &[Piece], edges: &mut [Option<Edge>], at: &mut [Option<usize>], link: usize, piece: Option<usize>) {
        let mut reached = vec![(link, piece)];
        let mut done = 0;
        loop {
            let next = match reached.get(done) {
                Some(&from) => next_edge(edges, at, from, false).map(|(edge, other)| (from, edge, other, false)),
                None => reached.iter().find_map(|&from| next_edge(edges, at, from, true).map(|(edge, other)| (from, edge, other, true))),
            };
            let Some(((link, _), edge, other, turned)) = next else {
                if done >= reached.len() {
                    return;
                }
                done += 1;
                continue;
            };
            let Some(Edge { mut joint, is_fixed, .. }) = edges[edge].take() else { continue };
            if turned {
                joint.axis = -joint.axis;
            }
            let mover = (!is_fixed).then(|| {
                self.joints.push(joint);
                self.joints.len() - 1
            });
            let own = self.push(pieces, other, link, mover);
            at[other] = Some(own);
            reached.push((own, Some(other)));
        }
    }

    fn push(&mut self, pieces: &[Piece], piece: usize, parent: usize, mover: Option<usize>) -> usize {
        let Piece { name, file_from_link, .. } = &pieces[piece];
        let (name, file_from_link) = (name.clone(), *file_from_link);
        self.links.push(Link { name, file_from_link, jointed: mover.is_some(), mocap: false, body: None, parent });
        self.movers.push(mover);
        self.pieces.push(Some(piece));
        self.links.len() - 1
    }

    /// Adds the bodies of the joints to the scene, and gives them what is in their links.
    pub(crate) fn add(&mut self, pieces: &[Piece], a: &mut Assembly) {
        add_bodies(&mut self.links, &mut self.joints, &self.movers, a);
        for (piece, link) in self.pieces.iter().zip(&self.links) {
            let (Some(piece), Some(body)) = (piece, link.body) else { continue };
            pieces[*piece].contents.iter().for_each(|span| a.carry_between(body, *span));
        }
        a.sort_bodies();
    }
}

/// The first joint that leads from a link to one that hangs nowhere yet, along its direction or against it, and that link.
fn next_edge(edges: &[Option<Edge>], at: &[Option<usize>], from: (usize, Option<usize>), turned: bool) -> Option<(usize, usize)> {
    let leads = |(number, edge): (usize, &Option<Edge>)| {
        let [near, far] = if turned { [1, 0] } else { [0, 1] };
        let edge = edge.as_ref().filter(|edge| edge.ends[near] == from.1)?;
        let other = edge.ends[far].filter(|other| at[*other].is_none())?;
        Some((number, other))
    };
    edges.iter().enumerate().find_map(leads)
}

/// Adds the bodies of joints to the scene; `movers` has the joint that moves each link, and links without one move with that around them.
pub(crate) fn add_bodies(links: &mut [Link], joints: &mut [Joint], movers: &[Option<usize>], a: &mut Assembly) {
    for at in 1..links.len() {
        let parent = links[links[at].parent].body;
        links[at].body = match movers[at] {
            Some(mover) => {
                let joint = &mut joints[mover];
                joint.push(&links[at].name, parent, a);
                joint.body.or(parent)
            }
            None => parent,
        };
    }
}
