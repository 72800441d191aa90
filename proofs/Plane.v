(** * The Euclidean plane

    dot, cross, len   == scalar product, determinant of two vectors, length
    J                 == the quarter turn
    add, smul, zero   == sum, multiple, origin

    - [dot_le], [cross_le]  Cauchy and Schwarz, both from Lagrange's identity;
    - [len_triangle]        the triangle inequality;
    - [frame]               coordinates in the orthogonal frame (w, J w).                            *)

From Kickdrift Require Import Vocabulary Stability.
From Coq Require Import Reals Lra Psatz.
Open Scope R_scope.

Definition dot (u w : vec) := position u * position w + velocity u * velocity w.
Definition cross (u w : vec) := position u * velocity w - velocity u * position w.          (* det (u, w) *)
Definition len (u : vec) := sqrt (dot u u).
Definition J (u : vec) := Vec (- velocity u) (position u).                         (* a quarter turn *)
Definition add (u w : vec) := Vec (position u + position w) (velocity u + velocity w).
Definition smul (x : R) (u : vec) := Vec (x * position u) (x * velocity u).
Definition zero := Vec 0 0.

Ltac coordinates := unfold dot, cross, J, add, smul, act, det, zero in *; simpl in *.

Lemma vec_ext u w : position u = position w -> velocity u = velocity w -> u = w.
Proof. destruct u, w; simpl; congruence. Qed.

Lemma len_nonneg u : 0 <= len u.
Proof. apply sqrt_pos. Qed.

Lemma len_sqr u : len u * len u = dot u u.
Proof. apply sqrt_sqrt; coordinates; nra. Qed.

Lemma len_pos u : u <> zero -> 0 < len u.
Proof.
  intros N; apply sqrt_lt_R0; destruct (Req_dec (position u) 0) as [A|A], (Req_dec (velocity u) 0) as [B|B];
    [exfalso; apply N; now apply vec_ext | coordinates; nra ..].
Qed.

Lemma len_J u : len (J u) = len u.
Proof. unfold len; f_equal; coordinates; ring. Qed.

(** Lagrange's identity gives both inequalities of Cauchy and Schwarz. *)
Lemma lagrange u w : dot u w * dot u w + cross u w * cross u w = dot u u * dot w w.
Proof. coordinates; ring. Qed.

Lemma dot_le u w : Rabs (dot u w) <= len u * len w.
Proof.
  pose proof (len_nonneg u); pose proof (len_nonneg w).
  apply sqr_le_abs; [nra|].
  replace (len u * len w * (len u * len w)) with (dot u u * dot w w) by (rewrite <- !len_sqr; ring).
  rewrite <- lagrange; nra.
Qed.

Lemma cross_le u w : Rabs (cross u w) <= len u * len w.
Proof.
  pose proof (len_nonneg u); pose proof (len_nonneg w).
  apply sqr_le_abs; [nra|].
  replace (len u * len w * (len u * len w)) with (dot u u * dot w w) by (rewrite <- !len_sqr; ring).
  rewrite <- lagrange; nra.
Qed.

(** Coordinates in the orthogonal frame (w, J w). *)
Lemma frame w v : w <> zero ->
  v = add (smul (dot w v / (len w * len w)) w) (smul (cross w v / (len w * len w)) (J w)).
Proof.
  intros Z; pose proof (len_pos w Z) as P; pose proof (len_sqr w) as S.
  assert (0 < dot w w) by nra; rewrite S.
  apply vec_ext; coordinates; field; lra.
Qed.

Lemma len_triangle u w : len (add u w) <= len u + len w.
Proof.
  pose proof (len_nonneg u); pose proof (len_nonneg w).
  apply Rsqr_incr_0_var; [|lra]; unfold Rsqr; rewrite len_sqr.
  pose proof (dot_le u w) as C; pose proof (len_sqr u); pose proof (len_sqr w); pose proof (Rle_abs (dot u w)).
  replace (dot (add u w) (add u w)) with (dot u u + 2 * dot u w + dot w w) by (coordinates; ring); nra.
Qed.

Lemma len_smul x u : len (smul x u) = Rabs x * len u.
Proof.
  apply Rsqr_inj; [apply len_nonneg | apply Rmult_le_pos; [apply Rabs_pos | apply len_nonneg] |]; unfold Rsqr.
  transitivity (Rabs x * Rabs x * (len u * len u)); [|ring].
  rewrite !len_sqr, <- Rabs_mult, (Rabs_pos_eq (x * x)) by nra; coordinates; ring.
Qed.
