(** * Edges of tongues, enclosed by computation

    At fixed p/q and rho the half period is a matrix function of s = h1^2 L1, here with h1 = 1. Where one of its entries has opposite
    signs at two rational points it vanishes between them: there Tr Q = 2 (B, C) or -2 (A, D), an edge.

    - [edge x p q rho a b]  entry x vanishes at some s between a and b;
    - [check_edge]          the computation, a boolean;
    - [edge_between]        check_edge = true proves the edge;
    - [certify_edge]        the tactic that generated files use.                                       *)

From Kickdrift Require Import Vocabulary Algebra TwoClocks Certificate.
From Coq Require Import Reals Qreals QArith ZArith Arith Bool Lia Lra Psatz.
Open Scope R_scope.

Inductive entry := A | B | C | D.

Definition entry_of (x : entry) (M : mat) := match x with A => mA M | B => mB M | C => mC M | D => mD M end.

Definition half_period_at (p q : nat) (rho s : R) := half_period p q 1 s (INR p / INR q) (rho * s).

Record edge (x : entry) (p q : nat) (rho a b : R) : Prop := {
  edge_terms : (1 <= p /\ 1 <= q /\ Nat.gcd p q = 1)%nat;
  edge_zero  : exists s, a < s < b /\ entry_of x (half_period_at p q rho s) = 0
}.

(** ** The computation *)

Definition zentry (x : entry) (M : zmat) := match x with A => zA M | B => zB M | C => zC M | D => zD M end.

(** 1, -1, or 0 where it is none of them. *)
Definition sign_at (x : entry) (p q : nat) (rho s : Q) : Z :=
  let zp := Z.of_nat p in
  let zq := Z.of_nat q in
  let x1 := Qred (s / (4 * inject_Z zq))%Q in
  let x2 := Qred (inject_Z zp * rho * s / (4 * inject_Z zq * inject_Z zq))%Q in
  let g := Z.gcd (QDen x1) (QDen x2) in
  let m := Z.to_pos (QDen x1 * (QDen x2 / g)) in
  let n1 := (Qnum x1 * (QDen x2 / g))%Z in
  let n2 := (Qnum x2 * (QDen x1 / g))%Z in
  if Qeq_bool (n1 # m) x1 && Qeq_bool (n2 # m) x2
  then match zrun zp zq (Zpos m) n1 n2 (p + q) with Some M => Z.sgn (zentry x M) | None => 0%Z end
  else 0%Z.

Definition check_edge (x : entry) (p q : nat) (rho a b : Q) : bool :=
  (1 <=? p)%nat && (1 <=? q)%nat && (Nat.gcd p q =? 1)%nat && Qle_bool a b &&
  (sign_at x p q rho a * sign_at x p q rho b =? -1)%Z.

(** ** Its meaning *)

Lemma sign_at_spec x p q rho s : (1 <= p)%nat -> (1 <= q)%nat ->
  let X := entry_of x (half_period_at p q (Q2R rho) (Q2R s)) in
  (sign_at x p q rho s = 1%Z -> 0 < X) /\ (sign_at x p q rho s = (-1)%Z -> X < 0).
Proof.
  intros P Q X; unfold sign_at; cbv zeta.
  set (m := Z.to_pos _); set (n1 := (Qnum (Qred (s / _)) * _)%Z); set (n2 := (Qnum (Qred (_ * s / _)) * _)%Z); clearbody m n1 n2.
  destruct (Qeq_bool (n1 # m) _ && _) eqn:E; [|split; discriminate].
  apply Bool.andb_true_iff in E; destruct E as [E1 E2]; apply Qeq_bool_eq, Qeq_eqR in E1, E2.
  rewrite (Qeq_eqR _ _ (Qred_correct _)) in E1; rewrite (Qeq_eqR _ _ (Qred_correct _)) in E2.
  assert (Ip : 0 < INR p) by (apply lt_0_INR; lia); assert (Iq : 0 < INR q) by (apply lt_0_INR; lia).
  assert (Four : Q2R 4 = 4) by (unfold Q2R; simpl; field).
  assert (Nonzero : forall c, Q2R c <> 0 -> ~ (c == 0)%Q).
  { intros c N Z; apply N; rewrite (Qeq_eqR _ _ Z); unfold Q2R; simpl; ring. }
  unfold Qdiv in E1, E2; rewrite Q2R_mult, Q2R_inv, !Q2R_mult, Q2R_inject, <- INR_IZR_INZ, Four in E1
    by (apply Nonzero; rewrite Q2R_mult, Q2R_inject, <- INR_IZR_INZ, Four; nra).
  rewrite Q2R_mult, Q2R_inv, !Q2R_mult, !Q2R_inject, <- !INR_IZR_INZ, Four in E2
    by (apply Nonzero; rewrite !Q2R_mult, !Q2R_inject, <- !INR_IZR_INZ, Four; nra).
  set (h2 := INR p / INR q).
  assert (K1 : 1 * Q2R s * tick q 1 / 2 = IZR n1 / IZR (Zpos m)).
  { transitivity (Q2R (n1 # m)); [rewrite E1; unfold tick; field; lra | reflexivity]. }
  assert (K2 : h2 * (Q2R rho * Q2R s) * tick p h2 / 2 = IZR n2 / IZR (Zpos m)).
  { transitivity (Q2R (n2 # m)); [rewrite E2; unfold tick, h2; field; lra | reflexivity]. }
  destruct (zrun _ _ _ _ _ _) as [M|] eqn:R; [|split; discriminate].
  apply (zrun_sound p q (Zpos m) n1 n2 _ _ _ M P Q ltac:(apply IZR_lt; lia) K1 K2) in R.
  rewrite in_ticks in R by (try assumption; try lra; unfold h2; field; lra).
  assert (T : 0 < tick q 1) by (unfold tick; apply Rdiv_lt_0_compat; lra).
  destruct R as (c & Cp & Ra & Rb & Rc & Rd); unfold rescale in *; simpl in Ra, Rb, Rc, Rd.
  assert (Inv : 0 < / tick q 1) by now apply Rinv_0_lt_compat.
  assert (Same : exists c', 0 < c' /\ IZR (zentry x M) = c' * X).
  { unfold X, half_period_at; fold h2; destruct x; simpl.
    - now exists c.
    - exists (c * / tick q 1); split; [nra | rewrite Rb; ring].
    - exists (c * tick q 1); split; [nra | rewrite Rc; field; lra].
    - now exists c. }
  destruct Same as (c' & C' & S); split; intros G.
  - apply Z.sgn_pos_iff, IZR_lt in G; nra.
  - apply Z.sgn_neg_iff, IZR_lt in G; nra.
Qed.

(** Entries are continuous in s. *)
Definition continuous (M : R -> mat) :=
  continuity (fun s => mA (M s)) /\ continuity (fun s => mB (M s)) /\
  continuity (fun s => mC (M s)) /\ continuity (fun s => mD (M s)).

Ltac four := split; [|split; [|split]].

Lemma continuous_const c : continuity (fun _ => c).
Proof. apply continuity_const; now intros ? ?. Qed.

Lemma continuity_ext f g : (forall s, f s = g s) -> continuity f -> continuity g.
Proof.
  intros E F s eps He; destruct (F s eps He) as (d & Hd & Near); exists d; split; [assumption|].
  intros t T; specialize (Near t T); simpl in *; now rewrite <- !E.
Qed.

Lemma continuous_mul M N : continuous M -> continuous N -> continuous (fun s => M s ** N s).
Proof.
  intros (A1 & B1 & C1 & D1) (A2 & B2 & C2 & D2).
  four; apply (continuity_plus (fun _ => _) (fun _ => _)); apply (continuity_mult (fun _ => _) (fun _ => _)); assumption.
Qed.

Lemma continuous_kick c : continuous (fun s => kick (c * s)).
Proof.
  four; simpl; try apply continuous_const.
  apply (continuity_opp (fun s => c * s)), continuity_scal, derivable_continuous, derivable_id.
Qed.

Lemma continuous_drift t : continuous (fun _ => drift t).
Proof. four; apply continuous_const. Qed.

Lemma continuous_schedule f d n : continuous (fun s => propagator (schedule (fun j => f j * s) d n)).
Proof.
  induction n as [|n IH]; [four; [exact (continuous_const 1) | exact (continuous_const 0) | exact (continuous_const 0) | exact (continuous_const 1)]|].
  assert (E : forall s, propagator (schedule (fun j => f j * s) d (S n)) =
    kick (f (S n) / 2 * s) ** drift d ** kick (f n / 2 * s) ** propagator (schedule (fun j => f j * s) d n)).
  { intros s; rewrite propagator_schedule_succ.
    replace (f (S n) * s / 2) with (f (S n) / 2 * s) by field; now replace (f n * s / 2) with (f n / 2 * s) by field. }
  assert (G : continuous (fun s => kick (f (S n) / 2 * s) ** drift d ** kick (f n / 2 * s) **
                                   propagator (schedule (fun j => f j * s) d n))).
  { repeat apply continuous_mul; auto using continuous_kick, continuous_drift. }
  destruct G as (GA & GB & GC & GD).
  four; [revert GA | revert GB | revert GC | revert GD]; apply continuity_ext; intros s; now rewrite E.
Qed.

Lemma continuous_entry x p q rho : continuity (fun s => entry_of x (half_period_at p q rho s)).
Proof.
  set (f := fun j => (if strikes q false j then 1 else 0) + (if strikes p false j then INR p / INR q * rho else 0)).
  destruct (continuous_schedule f (tick q 1) (p * q)) as (GA & GB & GC & GD).
  assert (E : forall s, half_period_at p q rho s = propagator (schedule (fun j => f j * s) (tick q 1) (p * q))).
  { intros s; unfold half_period_at, half_period; f_equal; apply schedule_ext; intros j _; unfold two_clocks, f.
    destruct (strikes q false j), (strikes p false j); ring. }
  destruct x; [revert GA | revert GB | revert GC | revert GD]; apply continuity_ext; intros s; now rewrite E.
Qed.

Theorem edge_between x p q rho a b r l u :
  r = Q2R rho -> l = Q2R a -> u = Q2R b -> check_edge x p q rho a b = true -> edge x p q r l u.
Proof.
  intros -> -> -> K; unfold check_edge in K; repeat rewrite Bool.andb_true_iff in K.
  destruct K as ((((P & Q) & G) & L) & S).
  apply Nat.leb_le in P, Q; apply Nat.eqb_eq in G; apply Qle_bool_iff, Qle_Rle in L; apply Z.eqb_eq in S.
  split; [auto|].
  set (F := fun s => entry_of x (half_period_at p q (Q2R rho) s)).
  pose proof (sign_at_spec x p q rho a P Q) as Sa; pose proof (sign_at_spec x p q rho b P Q) as Sb.
  cbv zeta in Sa, Sb; fold (F (Q2R a)) in Sa; fold (F (Q2R b)) in Sb.
  assert (Opposite : (0 < F (Q2R a) /\ F (Q2R b) < 0) \/ (F (Q2R a) < 0 /\ 0 < F (Q2R b))).
  { destruct Sa as [Sa Sa'], Sb as [Sb Sb'].
    assert (V : (sign_at x p q rho a = 1 /\ sign_at x p q rho b = -1 \/ sign_at x p q rho a = -1 /\ sign_at x p q rho b = 1)%Z).
    { assert (V : (sign_at x p q rho a | 1)%Z) by (exists (- sign_at x p q rho b)%Z; lia).
      apply Z.divide_1_r in V; destruct V as [V|V]; rewrite V in S |- *; lia. }
    destruct V as [[V W]|[V W]]; [left | right]; auto. }
  destruct (IVT_cor F (Q2R a) (Q2R b) (continuous_entry x p q (Q2R rho)) L ltac:(nra)) as (s & (Ls & Us) & Z).
  exists s; split; [|exact Z].
  split; apply Rnot_le_lt; intros N; [replace s with (Q2R a) in Z by lra | replace s with (Q2R b) in Z by lra]; lra.
Qed.

(** [certify_edge rho a b]: the rationals as elements of Q, denominators positive. *)
Ltac certify_edge rho a b :=
  apply (edge_between _ _ _ rho%Q a%Q b%Q);
  [ cbv [Q2R Qnum Qden]; lra .. | vm_cast_no_check (eq_refl true) ].
