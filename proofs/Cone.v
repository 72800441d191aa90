(** * The cone criterion

    The cone of two independent vectors u, w is { x u + y w : x, y >= 0 }, its interior asks x, y > 0.
    A determinant-one matrix that maps a cone into its own interior (or into the opposite one) is hyperbolic:
    a certificate that needs no zero test and in which rounding does not accumulate.

    - [cone_map]        a matrix that sends u, w into a cone sends their whole cone into it;
    - [cone_chain]      steps that map each cone into the next map the first into the last;
    - [cone_criterion]  a cone mapped into its interior: Tr > 2; into the opposite interior: Tr < -2;
    - [cone_hyperbolic] ... hence exponential growth.                                             *)

From Kickdrift Require Import Vocabulary Algebra Stability Plane.
From Coq Require Import Reals Lra Lia Psatz.
Open Scope R_scope.

Definition in_cone (u w v : vec) := exists x y, 0 <= x /\ 0 <= y /\ v = add (smul x u) (smul y w).
Definition inside (u w v : vec) := exists x y, 0 < x /\ 0 < y /\ v = add (smul x u) (smul y w).

Lemma act_combination M x y u w : M @ add (smul x u) (smul y w) = add (smul x (M @ u)) (smul y (M @ w)).
Proof. apply vec_ext; coordinates; ring. Qed.

Theorem cone_map M u w u' w' :
  in_cone u' w' (M @ u) -> in_cone u' w' (M @ w) -> forall v, in_cone u w v -> in_cone u' w' (M @ v).
Proof.
  intros (a & c & A & C & U) (b & d & B & D & V) v (x & y & X & Y & ->).
  exists (x * a + y * b), (x * c + y * d); rewrite act_combination, U, V.
  split; [nra|]; split; [nra|]; apply vec_ext; coordinates; ring.
Qed.

Fixpoint product (M : nat -> mat) (n : nat) : mat :=
  match n with O => one | S n' => M n' ** product M n' end.

Theorem cone_chain M u w n :
  (forall k, (k < n)%nat -> in_cone (u (S k)) (w (S k)) (M k @ u k) /\ in_cone (u (S k)) (w (S k)) (M k @ w k)) ->
  forall v, in_cone (u O) (w O) v -> in_cone (u n) (w n) (product M n @ v).
Proof.
  intros H v V; induction n as [|n IH]; simpl.
  - replace (one @ v) with v; [exact V | apply vec_ext; coordinates; ring].
  - rewrite act_mul; destruct (H n) as [A B]; [lia|].
    apply (cone_map (M n) (u n) (w n)); [exact A | exact B | apply IH; intros; apply H; lia].
Qed.

(** The matrix in the basis u, w has positive entries a, b, c, d with ad - bc = 1. *)
Theorem cone_criterion Q u w :
  det Q = 1 -> cross u w <> 0 ->
  (inside u w (Q @ u) -> inside u w (Q @ w) -> 2 < tr Q) /\
  (inside u w (smul (-1) (Q @ u)) -> inside u w (smul (-1) (Q @ w)) -> tr Q < -2).
Proof.
  intros D N.
  assert (Main : forall P, det P = 1 -> inside u w (P @ u) -> inside u w (P @ w) -> 2 < tr P).
  { clear Q D; intros Q D (a & c & A & C & U) (b & d & B & E & V).
    assert (T : cross u w * tr Q = cross u w * (a + d)).
    { transitivity (cross (Q @ u) w + cross u (Q @ w)); [unfold tr; coordinates; ring|].
      rewrite U, V; coordinates; ring. }
    assert (G : cross u w * det Q = cross u w * (a * d - b * c)).
    { transitivity (cross (Q @ u) (Q @ w)); [coordinates; ring | rewrite U, V; coordinates; ring]. }
    apply Rmult_eq_reg_l in T, G; [|assumption..].
    rewrite T; rewrite D in G; assert (0 < b * c) by nra.
    pose proof (Rle_0_sqr (a - d)) as S; unfold Rsqr in S; nra. }
  split; [now apply Main|]; intros U V.
  assert (T : 2 < tr (opp Q)); [|rewrite tr_opp in T; lra].
  assert (Neg : forall v, opp Q @ v = smul (-1) (Q @ v)) by (intros; apply vec_ext; simpl; ring).
  apply Main; [now rewrite det_opp | now rewrite Neg..].
Qed.

Corollary cone_hyperbolic Q u w :
  det Q = 1 -> cross u w <> 0 ->
  (inside u w (Q @ u) /\ inside u w (Q @ w)) \/ (inside u w (smul (-1) (Q @ u)) /\ inside u w (smul (-1) (Q @ w))) ->
  2 < Rabs (tr Q) /\ exponential_growth Q.
Proof.
  intros D N C; destruct (cone_criterion Q u w D N) as [P M].
  assert (T : 2 < Rabs (tr Q)).
  { destruct C as [[A B]|[A B]]; [specialize (P A B) | specialize (M A B)]; unfold Rabs; destruct Rcase_abs; lra. }
  split; [exact T | now apply hyperbolic].
Qed.
